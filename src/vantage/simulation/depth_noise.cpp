#include "vantage/simulation/depth_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// Pixels farther apart in depth lie on different surfaces, as normals have it.
constexpr double jump_in_footprints = RangeNormalOptions().max_step_in_footprints;

/// The noise-free image with all that the errors depend on.
class NoiseFreeImage {
 public:
  NoiseFreeImage(const RangeImage& image, const SensorModel& sensor) : image_(image), rays_(image.camera.rays()) {
    const auto [columns, rows] = rays_.resolution;
    pitch_ = 2 * std::max(rays_.x_half / columns, rays_.y_half / rows);
    if (sensor.dropout_from_incidence || sensor.incidence > 0 || sensor.lateral > 0) {
      normals_ = range_image_normals(image);
    }
  }

  [[nodiscard]] Resolution resolution() const { return rays_.resolution; }
  [[nodiscard]] std::size_t place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(rays_.resolution.columns) +
           static_cast<std::size_t>(column);
  }
  /// Unknown outside of the image.
  [[nodiscard]] float depth(int column, int row) const {
    const auto [columns, rows] = rays_.resolution;
    if (column < 0 || column >= columns || row < 0 || row >= rows) return RangeImage::unknown;
    return image_.depth[place(column, row)];
  }
  /// 0 where there is no normal.
  [[nodiscard]] double cosine(int column, int row) const {
    if (normals_.empty()) return 0;
    const Vec3 ray(rays_.x(column), rays_.y(row), 1);
    return std::abs(ray.normalized().dot(normals_[place(column, row)].cast<double>()));
  }
  [[nodiscard]] bool is_jump(double a, double b) const {
    return std::abs(a - b) > jump_in_footprints * pitch_ * std::min(a, b);
  }
  /// Depth of the surface at one pixel, continued as a plane to the ray of another one nearby.
  [[nodiscard]] double continued(int column, int row, int to_column, int to_row) const {
    const auto depth_here = static_cast<double>(depth(column, row));
    const Vec3 normal = normals_[place(column, row)].cast<double>();
    const double along = normal.dot(Vec3(rays_.x(to_column), rays_.y(to_row), 1));
    if (along >= 0) return depth_here;
    const double continued_depth = normal.dot(point_in_sensor(rays_, column, row, depth_here)) / along;
    return is_jump(continued_depth, depth_here) ? depth_here : continued_depth;
  }

 private:
  const RangeImage& image_;
  RayGrid rays_;
  double pitch_ = 0;  // between neighbouring pixels, as a tangent
  std::vector<Vec3f> normals_;
};

template <class Visit>
void for_each_pixel(Resolution resolution, const Visit& visit) {
  for (int row = 0; row < resolution.rows; ++row) {
    for (int column = 0; column < resolution.columns; ++column) visit(column, row);
  }
}

void drop_by_incidence(RangeImage& image, const NoiseFreeImage& truth, double from, Random& random) {
  constexpr double right_angle = std::numbers::pi / 2;
  for_each_pixel(truth.resolution(), [&](int column, int row) {
    const double cosine = truth.cosine(column, row);
    if (cosine == 0) return;
    const double lost_share = (std::acos(std::min(1.0, cosine)) - from) / (right_angle - from);
    if (random.uniform() < lost_share) image.depth[truth.place(column, row)] = RangeImage::unknown;
  });
}

/// Pixels next to an edge measure what lies beside them.
void shift_edges(RangeImage& image, const NoiseFreeImage& truth, double lateral, Random& random) {
  const auto offset = [&] {
    const double pixels = std::clamp(lateral * random.normal(), -1000.0, 1000.0);
    return static_cast<int>(std::lround(pixels));
  };
  for_each_pixel(truth.resolution(), [&](int column, int row) {
    float& depth = image.depth[truth.place(column, row)];
    if (depth == RangeImage::unknown) return;
    const int other_column = column + offset();
    const int other_row = row + offset();
    const float other = truth.depth(other_column, other_row);
    if (other == RangeImage::unknown) return;
    const bool is_hit = RangeImage::is_hit(depth);
    if (!RangeImage::is_hit(other)) {
      if (is_hit) depth = RangeImage::no_return;
    } else if (!is_hit || truth.is_jump(static_cast<double>(depth), static_cast<double>(other))) {
      depth = static_cast<float>(truth.continued(other_column, other_row, column, row));
    }
  });
}

/// Some of the pixels that have both surfaces of an edge beside them measure something in between.
void mix_edges(RangeImage& image, const NoiseFreeImage& truth, double share, Random& random) {
  for_each_pixel(truth.resolution(), [&](int column, int row) {
    float& depth = image.depth[truth.place(column, row)];
    if (!RangeImage::is_hit(depth)) return;
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = 0;
    for (const auto& [columns, rows] : {std::pair(0, 0), {-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const float beside = truth.depth(column + columns, row + rows);
      if (!RangeImage::is_hit(beside)) continue;
      nearest = std::min(nearest, static_cast<double>(beside));
      farthest = std::max(farthest, static_cast<double>(beside));
    }
    if (nearest >= farthest || !truth.is_jump(nearest, farthest) || random.uniform() >= share) return;
    depth = static_cast<float>(random.uniform(nearest, farthest));
  });
}

float disturbed(double depth, double cosine, const RangeCamera& camera, const SensorModel& sensor, Random& random) {
  const double measured = sensor.quantised(depth + sensor.noise(depth, cosine) * random.normal());
  const bool within_limits = measured > 0 && measured >= camera.min_depth && measured <= camera.max_depth;
  return within_limits ? static_cast<float>(measured) : RangeImage::unknown;
}

}  // namespace

RangeImage noisy(RangeImage image, const SensorModel& sensor, Random& random) {
  sensor.validate();
  if (sensor.is_ideal()) return image;
  const RangeImage noise_free = image;
  const NoiseFreeImage truth(noise_free, sensor);
  if (sensor.dropout_from_incidence) drop_by_incidence(image, truth, *sensor.dropout_from_incidence, random);
  if (sensor.lateral > 0) shift_edges(image, truth, sensor.lateral, random);
  if (sensor.mixed > 0) mix_edges(image, truth, sensor.mixed, random);
  SensorModel rest = sensor;
  rest.dropout_from_incidence.reset();
  rest.lateral = rest.mixed = rest.dropout = 0;
  if (!rest.is_ideal()) {
    for_each_pixel(truth.resolution(), [&](int column, int row) {
      float& depth = image.depth[truth.place(column, row)];
      if (!RangeImage::is_hit(depth)) return;
      const double cosine = sensor.incidence > 0 ? truth.cosine(column, row) : 1;
      depth = disturbed(static_cast<double>(depth), cosine == 0 ? 1 : cosine, image.camera, sensor, random);
    });
  }
  if (sensor.dropout > 0) {
    for (float& depth : image.depth) {
      if (depth != RangeImage::unknown && random.uniform() < sensor.dropout) depth = RangeImage::unknown;
    }
  }
  return image;
}

}  // namespace vantage
