#include "vantage/map/lattice_projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage {
namespace {

constexpr double pixel_margin = 1e-6;  // for the rounding of u/w
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The first of `count` pixels whose coordinate is at least `low`; `count` where there is none.
int first_from(double low, int count) {
  const double clamped = std::clamp(low, 0.0, static_cast<double>(count));
  const int whole = static_cast<int>(clamped);
  return whole < clamped ? whole + 1 : whole;
}

/// The last of `count` pixels whose coordinate is at most `high`; -1 where there is none.
int last_to(double high, int count) { return static_cast<int>(std::clamp(high, -1.0, count - 1.0) + 1) - 1; }

}  // namespace

double LatticeProjection::dense_depth(const Grid& grid, const RangeCamera& camera) {
  // The nearest ray misses the centre by at most half a pixel along both axes, and the voxel encloses a ball around it.
  const RayGrid rays = camera.rays();
  const double half_diagonal = std::hypot(rays.x_half / rays.resolution.columns, rays.y_half / rays.resolution.rows);
  return 0.4999 * grid.length / half_diagonal;
}

void LatticeProjection::prepare(const Grid& grid, const IndexBox& box, const RangeCamera& camera, const View& view) {
  const RayGrid rays = camera.rays();
  resolution_ = camera.resolution;
  near_ = camera.min_depth;
  // Pixels per tangent, and the pixel of tangent 0.
  const double fx = 0.5 * resolution_.columns / rays.x_half;
  const double fy = 0.5 * resolution_.rows / rays.y_half;
  const double cx = 0.5 * resolution_.columns - 0.5 - fx * rays.x_middle;
  const double cy = 0.5 * resolution_.rows - 0.5 - fy * rays.y_middle;
  const Mat3 rotation = view.world_from_sensor.linear();
  const Vec3 u = fx * rotation.col(0) + cx * rotation.col(2);
  const Vec3 v = fy * rotation.col(1) + cy * rotation.col(2);
  const Vec3 w = rotation.col(2);
  const Vec3 eye = view.position();
  for (int a = 0; a < 3; ++a) {
    std::vector<Homogeneous>& table = tables_[static_cast<std::size_t>(a)];
    table.clear();
    for (int k = box.min[a]; k <= box.max[a] + 1; ++k) {
      const double offset = grid.plane(a, k) - eye[a];
      table.push_back({u[a] * offset, v[a] * offset, w[a] * offset});
    }
  }
  const Box3 space = grid.box(box);
  const double farthest_coordinate =
      std::max({space.min().cwiseAbs().maxCoeff(), space.max().cwiseAbs().maxCoeff(), eye.cwiseAbs().maxCoeff()});
  slack_ = 0x1p-44 * farthest_coordinate;
  const double columns_and_rows = resolution_.columns + resolution_.rows;
  slack_in_pixels_ = slack_ * (u.norm() + v.norm() + columns_and_rows);
  dense_depth_ = dense_depth(grid, camera) * (1 - 4 * slack_ / grid.length);
}

PixelRect LatticeProjection::pixels_within(double left, double right, double top, double bottom, double margin) const {
  return {first_from(left - margin, resolution_.columns), last_to(right + margin, resolution_.columns),
          first_from(top - margin, resolution_.rows), last_to(bottom + margin, resolution_.rows)};
}

LatticeProjection::Footprint LatticeProjection::footprint(const Index3& low, const Index3& high) const {
  const double last_column = resolution_.columns - 1;
  const double last_row = resolution_.rows - 1;
  double max_w = 0, min_w = 0, max_u = 0, max_v = 0, max_right = 0, max_below = 0;
  for (int a = 0; a < 3; ++a) {
    const Homogeneous& p = at(a, low[a]);
    const Homogeneous& q = at(a, high[a]);
    min_w += std::min(p.w, q.w);
    max_w += std::max(p.w, q.w);
    max_u += std::max(p.u, q.u);
    max_v += std::max(p.v, q.v);
    max_right += std::max(last_column * p.w - p.u, last_column * q.w - q.u);
    max_below += std::max(last_row * p.w - p.v, last_row * q.w - q.v);
  }
  Footprint footprint;
  footprint.min_depth = min_w - slack_;
  footprint.max_depth = max_w + slack_;
  // A ray of the image has t = w > near, 0 <= u <= last_column*w and 0 <= v <= last_row*w.
  if (footprint.max_depth < near_ || std::min({max_u, max_v, max_right, max_below}) < -slack_in_pixels_) {
    return footprint;
  }
  footprint.pixels = {0, resolution_.columns - 1, 0, resolution_.rows - 1};
  const double margin = pixel_margin + slack_in_pixels_ / min_w;
  if (min_w <= 0 || margin > 0.01) {
    footprint.kind = Footprint::Kind::anywhere;
    return footprint;
  }
  double left = infinity, right = -left, top = left, bottom = -left;
  for (int corner_of_box = 0; corner_of_box < 8; ++corner_of_box) {
    const auto [u, v, w] =
        corner((corner_of_box & 1) != 0 ? high.x() : low.x(), (corner_of_box & 2) != 0 ? high.y() : low.y(),
               (corner_of_box & 4) != 0 ? high.z() : low.z());
    const double inverse = 1 / w;
    left = std::min(left, u * inverse);
    right = std::max(right, u * inverse);
    top = std::min(top, v * inverse);
    bottom = std::max(bottom, v * inverse);
  }
  footprint.kind = Footprint::Kind::bounded;
  footprint.is_in_image = left >= 0 && top >= 0 && right <= last_column && bottom <= last_row;
  footprint.margin = margin;
  footprint.pixels = pixels_within(left, right, top, bottom, margin);
  if (footprint.pixels.is_empty()) footprint.kind = Footprint::Kind::none;
  return footprint;
}

}  // namespace vantage
