#include "vantage/sensor/range_camera.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "vantage/core/error.hpp"

namespace vantage {

namespace {

constexpr int most_rays = 16384;  // per axis: their number fits in an int, their bits in memory

void require_rays(Resolution resolution, std::string_view what) {
  const auto [columns, rows] = resolution;
  require(columns > 0 && rows > 0, what, " = ", columns, "x", rows, ": must be at least 1x1");
  require(columns <= most_rays && rows <= most_rays, what, " = ", columns, "x", rows, ": must be at most ", most_rays,
          "x", most_rays);
}

}  // namespace

void RangeCamera::validate() const {
  require_rays(resolution, "resolution");
  for (const double tangent : {left, right, top, bottom}) {
    require(std::isfinite(tangent), "field of view: border tangent ", tangent, " must be a finite number");
  }
  require(left < right && top < bottom, "field of view: must be wider than 0 and below 180 degrees");
  require(std::isfinite(min_depth) && min_depth >= 0, "min_depth = ", min_depth, " m: must not be negative");
  require(max_depth > min_depth, "max_depth = ", max_depth, " m: must be greater than min_depth = ", min_depth, " m");
  if (max_incidence) {
    require(*max_incidence > 0 && *max_incidence <= std::numbers::pi / 2, "max_incidence = ", degrees(*max_incidence),
            " degrees: must be in (0, 90]");
  }
}

RayGrid RangeCamera::rays(Resolution ray_resolution) const {
  require_rays(ray_resolution, "rays of a view");
  return {ray_resolution, 0.5 * (left + right), 0.5 * (right - left), 0.5 * (top + bottom), 0.5 * (bottom - top)};
}

double RangeCamera::horizontal_aperture() const { return std::atan(right) - std::atan(left); }
double RangeCamera::vertical_aperture() const { return std::atan(bottom) - std::atan(top); }

RangeCamera camera_from_apertures(double horizontal, double vertical, Resolution resolution) {
  for (const double aperture : {horizontal, vertical}) {
    require(aperture > 0 && aperture < std::numbers::pi, "aperture = ", degrees(aperture),
            " degrees: must be greater than 0 and less than 180");
  }
  const double x = std::tan(horizontal / 2);
  const double y = std::tan(vertical / 2);
  RangeCamera camera;
  camera.resolution = resolution;
  camera.left = -x;
  camera.right = x;
  camera.top = -y;
  camera.bottom = y;
  camera.validate();
  return camera;
}

RangeCamera camera_from_intrinsics(double fx, double fy, double cx, double cy, Resolution resolution) {
  require(fx > 0 && fy > 0 && std::isfinite(fx) && std::isfinite(fy), "intrinsics: fx = ", fx, ", fy = ", fy,
          ": focal lengths must be positive (pixels)");
  require(cx > -0.5 && cx < resolution.columns - 0.5 && cy > -0.5 && cy < resolution.rows - 0.5,
          "intrinsics: principal point (", cx, ", ", cy, ") lies outside the ", resolution.columns, "x",
          resolution.rows, " image; do the intrinsics belong to another resolution?");
  RangeCamera camera;
  camera.resolution = resolution;
  camera.left = (-0.5 - cx) / fx;
  camera.right = (resolution.columns - 0.5 - cx) / fx;
  camera.top = (-0.5 - cy) / fy;
  camera.bottom = (resolution.rows - 0.5 - cy) / fy;
  camera.validate();
  return camera;
}

Resolution ideal_resolution(const RangeCamera& camera, double voxel_length, double distance) {
  require(voxel_length > 0 && std::isfinite(voxel_length), "voxel_length = ", voxel_length, " m: must be positive");
  require(distance >= 0 && distance <= 1e6 * voxel_length, "distance = ", distance,
          " m: must be within 0 and a million voxel lengths");
  // Nearer than a voxel eq. 14 has no solution; one ray per voxel-sized radius is the nearest meaning.
  const double angle = std::asin(std::min(1.0, voxel_length / std::max(distance, voxel_length)));
  const auto count = [angle](double aperture) {
    // The tolerance keeps an aperture that is a whole multiple from being rounded up by the last bit.
    return std::max(1.0, std::ceil(aperture / angle - 1e-9));
  };
  const double columns = count(camera.horizontal_aperture()), rows = count(camera.vertical_aperture());
  require(columns <= most_rays && rows <= most_rays, "rays: ", distance, " m away from voxels of ", voxel_length,
          " m one per voxel would be ", columns, "x", rows, ", more than ", most_rays, "x", most_rays,
          "; take longer voxels, nearer views, or rays of a fixed resolution");
  return {static_cast<int>(columns), static_cast<int>(rows)};
}

}  // namespace vantage
