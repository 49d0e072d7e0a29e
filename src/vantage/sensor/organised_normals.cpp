#include "vantage/sensor/organised_normals.hpp"

#include <cmath>
#include <optional>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr double steepest_step = 12;

/// The neighbour's offset from a point, where both lie on one surface.
std::optional<Vec3> step_on_surface(const Vec3& here, const Vec3& neighbour, const Vec3& sight) {
  const Vec3 step = neighbour - here;
  const double along = std::abs(step.dot(sight));
  const double across = std::sqrt(std::max(0.0, step.squaredNorm() - along * along));
  if (!(across > 0) || along > steepest_step * across) return std::nullopt;
  return step;
}

/// The tangent from the neighbours on both sides, or from the one there is.
std::optional<Vec3> tangent(const std::optional<Vec3>& before, const std::optional<Vec3>& after) {
  if (before && after) return *after - *before;
  if (after) return after;
  if (before) return Vec3(-*before);
  return std::nullopt;
}

}  // namespace

std::vector<Vec3f> organised_normals(Resolution grid, std::span<const std::int32_t> point_of_cell,
                                     std::span<const Vec3> points, std::span<const Vec3> origins) {
  require(point_of_cell.size() == static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows),
          "organised cloud: ", point_of_cell.size(), " cells for ", grid.columns, "x", grid.rows);
  require(origins.size() == 1 || origins.size() == points.size(), "organised cloud: ", origins.size(), " origins for ",
          points.size(), " points; must be one, or one per point");
  const auto point_at = [&](int column, int row) {
    if (column < 0 || column >= grid.columns || row < 0 || row >= grid.rows) return -1;
    return point_of_cell[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                         static_cast<std::size_t>(column)];
  };
  std::vector<Vec3f> normals(points.size(), Vec3f::Zero());
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::int32_t index = point_at(column, row);
      if (index < 0) continue;
      const auto i = static_cast<std::size_t>(index);
      const Vec3& here = points[i];
      const Vec3 sight = (here - origins[origins.size() == 1 ? 0 : i]).normalized();
      const auto step = [&](int other_column, int other_row) -> std::optional<Vec3> {
        const std::int32_t other = point_at(other_column, other_row);
        if (other < 0) return std::nullopt;
        return step_on_surface(here, points[static_cast<std::size_t>(other)], sight);
      };
      const auto along_row = tangent(step(column - 1, row), step(column + 1, row));
      const auto along_column = tangent(step(column, row - 1), step(column, row + 1));
      if (!along_row || !along_column) continue;
      Vec3 normal = along_row->cross(*along_column);
      const double length = normal.norm();
      // Tangents that are nearly parallel say nothing about the surface.
      if (!(length > 1e-6 * along_row->norm() * along_column->norm())) continue;
      if (normal.dot(sight) > 0) normal = -normal;
      normals[i] = (normal / length).cast<float>();
    }
  }
  return normals;
}

}  // namespace vantage
