#include "vantage/sensor/range_image.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// The surface's tangent along one image axis at a pixel, from whichever neighbours lie on the same surface.
struct Tangent {
  Vec3 direction = Vec3::Zero();
  bool found = false;
};

Tangent tangent(const Vec3& here, const Vec3& before, bool before_is_near, const Vec3& after, bool after_is_near) {
  if (before_is_near && after_is_near) return {after - before, true};
  if (after_is_near) return {after - here, true};
  if (before_is_near) return {here - before, true};
  return {};
}

}  // namespace

void RangeImage::validate() const {
  camera.validate();
  const auto expected =
      static_cast<std::size_t>(camera.resolution.columns) * static_cast<std::size_t>(camera.resolution.rows);
  require(depth.size() == expected, "range image: ", depth.size(), " depths for ", camera.resolution.columns, "x",
          camera.resolution.rows, " pixels; must be ", expected);
  const auto bad = std::find_if(depth.begin(), depth.end(), [](float value) { return !(value >= 0); });
  if (bad == depth.end()) return;
  const auto pixel = bad - depth.begin();
  throw InputError(concat("range image: depth ", *bad, " at pixel (", pixel % camera.resolution.columns, ", ",
                          pixel / camera.resolution.columns, "): must be 0 (unknown), positive or infinite"));
}

void RangeNormalOptions::validate() const {
  require(max_step_in_footprints > 0, "max_step_in_footprints = ", max_step_in_footprints, ": must be positive");
}

std::vector<Vec3f> range_image_normals(const RangeImage& image, const RangeNormalOptions& options) {
  options.validate();
  const RayGrid rays = image.camera.rays();
  const auto [columns, rows] = image.camera.resolution;
  const double pixel = 2 * std::max(rays.x_half / columns, rays.y_half / rows);
  std::vector<Vec3f> normals(image.depth.size(), Vec3f::Zero());
  // A table of directions: each takes a division, and each point is asked for five times.
  std::vector<double> x(static_cast<std::size_t>(columns)), y(static_cast<std::size_t>(rows));
  for (int column = 0; column < columns; ++column) x[static_cast<std::size_t>(column)] = rays.x(column);
  for (int row = 0; row < rows; ++row) y[static_cast<std::size_t>(row)] = rays.y(row);
  const auto point = [&](int column, int row) {
    const auto depth = static_cast<double>(image.at(column, row));
    return Vec3(x[static_cast<std::size_t>(column)] * depth, y[static_cast<std::size_t>(row)] * depth, depth);
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const float depth = image.at(column, row);
      if (!RangeImage::is_hit(depth)) continue;
      const double limit = options.max_step_in_footprints * pixel * static_cast<double>(depth);
      const auto is_near = [&](int other_column, int other_row) {
        if (other_column < 0 || other_column >= columns || other_row < 0 || other_row >= rows) return false;
        const float other = image.at(other_column, other_row);
        return RangeImage::is_hit(other) && std::abs(static_cast<double>(other) - static_cast<double>(depth)) <= limit;
      };
      const auto point_if = [&](bool wanted, int c, int r) { return wanted ? point(c, r) : Vec3(Vec3::Zero()); };
      const bool left = is_near(column - 1, row), right = is_near(column + 1, row);
      const bool above = is_near(column, row - 1), below = is_near(column, row + 1);
      const Vec3 here = point(column, row);
      const Tangent along_row =
          tangent(here, point_if(left, column - 1, row), left, point_if(right, column + 1, row), right);
      const Tangent along_column =
          tangent(here, point_if(above, column, row - 1), above, point_if(below, column, row + 1), below);
      if (!along_row.found || !along_column.found) continue;
      Vec3 normal = along_column.direction.cross(along_row.direction);
      const double length = normal.norm();
      if (!(length > 1e-30)) continue;
      if (normal.dot(here) > 0) normal = -normal;
      normals[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)] =
          (normal / length).cast<float>();
    }
  }
  return normals;
}

}  // namespace vantage
