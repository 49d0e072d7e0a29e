#include "vantage/simulation/depth_noise.hpp"

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr double right_angle = std::numbers::pi / 2;

double incidence(const Vec3& ray, const Vec3f& normal) {
  return std::acos(std::min(1.0, std::abs(ray.normalized().dot(normal.cast<double>()))));
}

void drop_pixels(RangeImage& image, double from, Random& random) {
  const std::vector<Vec3f> normals = range_image_normals(image);
  const RayGrid rays = image.camera.rays();
  std::size_t pixel = 0;
  for (int row = 0; row < rays.resolution.rows; ++row) {
    for (int column = 0; column < rays.resolution.columns; ++column, ++pixel) {
      if (normals[pixel].isZero(0)) continue;
      const double angle = incidence({rays.x(column), rays.y(row), 1}, normals[pixel]);
      const double lost_share = (angle - from) / (right_angle - from);
      if (random.uniform() < lost_share) image.depth[pixel] = RangeImage::unknown;
    }
  }
}

float disturbed(double depth, const RangeCamera& camera, const DepthNoise& noise, Random& random) {
  const double sigma = noise.a + noise.b * depth * depth;
  double measured = depth + sigma * random.normal();
  if (noise.quantum > 0) measured = std::round(measured / noise.quantum) * noise.quantum;
  const bool within_limits = measured > 0 && measured >= camera.min_depth && measured <= camera.max_depth;
  return within_limits ? static_cast<float>(measured) : RangeImage::unknown;
}

}  // namespace

void DepthNoise::validate() const {
  constexpr double largest = 1e6;  // metres, as for the scene
  require(a >= 0 && a <= largest, "depth noise: a = ", a, " m: must be from 0 to ", largest);
  require(b >= 0 && b <= largest, "depth noise: b = ", b, " 1/m: must be from 0 to ", largest);
  require(quantum >= 0 && quantum <= largest, "depth noise: quantum = ", quantum, " m: must be from 0 to ", largest);
  if (dropout_from_incidence) {
    require(*dropout_from_incidence >= 0 && *dropout_from_incidence < right_angle,
            "depth noise: dropout_from_incidence = ", degrees(*dropout_from_incidence),
            " degrees: must be at least 0 and less than 90");
  }
}

RangeImage noisy(RangeImage image, const DepthNoise& noise, Random& random) {
  noise.validate();
  // Dropouts first: the normals of the noise-free image tell the incidence.
  if (noise.dropout_from_incidence) drop_pixels(image, *noise.dropout_from_incidence, random);
  if (noise.a == 0 && noise.b == 0 && noise.quantum == 0) return image;
  for (float& depth : image.depth) {
    if (RangeImage::is_hit(depth)) depth = disturbed(static_cast<double>(depth), image.camera, noise, random);
  }
  return image;
}

}  // namespace vantage
