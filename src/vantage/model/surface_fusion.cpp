#include "vantage/model/surface_fusion.hpp"

#include <algorithm>

#include "vantage/core/parallel.hpp"
#include "vantage/model/surface_key_set.hpp"

namespace vantage {
namespace {

// A plane through a pixel's point says little about places this many bands along the ray from it.
constexpr float band_along_ray = 4;

/// The image of the world in a frame, in single precision.
struct Projection {
  Eigen::Matrix3f sensor_from_world;
  Vec3f origin;  // of the world, in the sensor frame
  float fx, fy, cx, cy;

  Projection(const View& view, const RayGrid& rays)
      : sensor_from_world(view.world_from_sensor.linear().transpose().cast<float>()),
        origin((view.world_from_sensor.inverse() * Vec3(Vec3::Zero())).cast<float>()),
        fx(static_cast<float>(rays.resolution.columns / (2 * rays.x_half))),
        fy(static_cast<float>(rays.resolution.rows / (2 * rays.y_half))),
        // Half a pixel more, so that rounding down finds the nearest pixel.
        cx(static_cast<float>(0.5 * rays.resolution.columns * (1 - rays.x_middle / rays.x_half))),
        cy(static_cast<float>(0.5 * rays.resolution.rows * (1 - rays.y_middle / rays.y_half))) {}
};

/// Writes one frame into one block after the other.
class FrameFuser {
 public:
  FrameFuser(const SurfaceFrame& frame, const View& view, double cell, std::uint16_t number)
      : frame_(frame),
        projection_(view, frame.rays()),
        world_from_sensor_(view.world_from_sensor.linear().cast<float>()),
        cell_(cell),
        number_(number) {
    const RayGrid& rays = frame.rays();
    for (int column = 0; column < rays.resolution.columns; ++column)
      x_of_column_.push_back(static_cast<float>(rays.x(column)));
    for (int row = 0; row < rays.resolution.rows; ++row) y_of_row_.push_back(static_cast<float>(rays.y(row)));
  }

  void fuse(SurfaceBlock& block) const {
    constexpr int length = SurfaceBlock::side_length;
    const Vec3 first = cell_ * length * block.key.cast<double>();
    const Vec3f corner = projection_.sensor_from_world * first.cast<float>() + projection_.origin;
    if (is_out_of_sight(corner)) return;
    const Eigen::Matrix3f step = static_cast<float>(cell_) * projection_.sensor_from_world;
    std::size_t node = 0;
    for (int z = 0; z < length; ++z) {
      for (int y = 0; y < length; ++y) {
        const Vec3f row = corner + static_cast<float>(y) * step.col(1) + static_cast<float>(z) * step.col(2);
        for (int x = 0; x < length; ++x, ++node) fuse(block, node, row + static_cast<float>(x) * step.col(0));
      }
    }
  }

 private:
  /// No node of the block with its first node there lies in the image.
  [[nodiscard]] bool is_out_of_sight(const Vec3f& corner) const {
    const float half = static_cast<float>(cell_) * (SurfaceBlock::side_length - 1) / 2;
    const Vec3f middle = corner + projection_.sensor_from_world * Vec3f::Constant(half);
    const float radius = 1.7321F * half;
    if (middle.z() + radius <= 0) return true;
    const RayGrid& rays = frame_.rays();
    const auto beyond = [&](float across, float slope, float sign) {  // a plane through the sensor
      return sign * (across - slope * middle.z()) > radius * std::sqrt(1 + slope * slope);
    };
    const auto left = static_cast<float>(rays.x_middle - rays.x_half),
               right = static_cast<float>(rays.x_middle + rays.x_half);
    const auto top = static_cast<float>(rays.y_middle - rays.y_half),
               bottom = static_cast<float>(rays.y_middle + rays.y_half);
    return beyond(middle.x(), left, -1) || beyond(middle.x(), right, 1) || beyond(middle.y(), top, -1) ||
           beyond(middle.y(), bottom, 1);
  }

  void fuse(SurfaceBlock& block, std::size_t node, const Vec3f& place) const {
    if (place.z() < static_cast<float>(frame_.min_depth()) || place.z() <= 0) return;
    const float inverse = 1 / place.z();
    const float u = projection_.fx * place.x() * inverse + projection_.cx;
    const float v = projection_.fy * place.y() * inverse + projection_.cy;
    const Resolution& size = frame_.rays().resolution;
    if (!(u >= 0 && v >= 0 && u < static_cast<float>(size.columns) && v < static_cast<float>(size.rows))) return;
    const int column = static_cast<int>(u), row = static_cast<int>(v);
    const SurfacePixel& pixel = frame_.pixel(column, row);
    if (pixel.depth == RangeImage::unknown) return;
    if (pixel.depth == RangeImage::no_return) {
      if (pixel.nearest == RangeImage::no_return && place.z() < static_cast<float>(frame_.max_depth()))
        look_through(block, node);
      return;
    }
    const float band = surface_band(pixel.sigma, static_cast<float>(cell_));
    const float before = pixel.depth - place.z();
    if (before < -band_along_ray * band) return;  // hidden
    const Vec3f point(pixel.depth * x_of_column_[static_cast<std::size_t>(column)],
                      pixel.depth * y_of_row_[static_cast<std::size_t>(row)], pixel.depth);
    const float distance = pixel.normal.dot(place - point);
    if (distance < -band) return;
    if (before > band_along_ray * band || distance > band) {
      // Beside an edge a ray does not say on which side of it the node lies.
      if (pixel.nearest - place.z() > band) look_through(block, node);
      return;
    }
    if (pixel.weight == 0) return;
    const float certainty = std::min(1.0F, (band + distance) / (band - 2 * pixel.sigma));
    block.add(node, {distance, certainty * pixel.weight, world_from_sensor_ * pixel.normal, certainty, number_});
  }

  static void look_through(SurfaceBlock& block, std::size_t node) {
    std::uint16_t& count = block.nodes[node].looked_through;
    if (count < 65535) ++count;
  }

  const SurfaceFrame& frame_;
  Projection projection_;
  Eigen::Matrix3f world_from_sensor_;
  double cell_;
  std::uint16_t number_;
  std::vector<float> x_of_column_, y_of_row_;
};

}  // namespace

std::vector<Index3> blocks_near(const SurfaceFrame& frame, const View& view, double cell, const Box3& region) {
  constexpr int stride = 2;  // pixels; cells are no finer than pixels, blocks far longer
  constexpr int rows_per_chunk = 64;
  const Resolution& size = frame.rays().resolution;
  const double block = cell * SurfaceBlock::side_length;
  const float margin = 1.5F / SurfaceBlock::side_length;
  const Eigen::AlignedBox3f inside(Vec3f((region.min() / block).cast<float>() - Vec3f::Constant(margin)),
                                   Vec3f((region.max() / block).cast<float>() + Vec3f::Constant(margin)));
  const Vec3f origin = (view.position() / block).cast<float>();
  const std::size_t chunks = static_cast<std::size_t>((size.rows + rows_per_chunk - 1) / rows_per_chunk);
  std::vector<std::vector<std::uint64_t>> found(chunks);
  parallel_for(chunks, [&](std::size_t chunk) {
    KeySet keys;
    const int end = std::min(size.rows, static_cast<int>(chunk + 1) * rows_per_chunk);
    for (int row = static_cast<int>(chunk) * rows_per_chunk; row < end; row += stride) {
      for (int column = 0; column < size.columns; column += stride) {
        const SurfacePixel& pixel = frame.pixel(column, row);
        if (!RangeImage::is_hit(pixel.depth)) continue;
        const Vec3f ray =
            (ray_direction(view.world_from_sensor.linear(), frame.rays().x(column), frame.rays().y(row)) / block)
                .cast<float>();
        const float band = surface_band(pixel.sigma, static_cast<float>(cell));
        const float cosine = std::max(0.25F, -pixel.normal.dot(Vec3f(static_cast<float>(frame.rays().x(column)),
                                                                     static_cast<float>(frame.rays().y(row)), 1)
                                                                   .normalized()));
        const float reach = band / cosine;
        const int steps = std::max(1, static_cast<int>(std::ceil(4 * reach * ray.norm())));  // half blocks
        for (int i = 0; i <= steps; ++i) {
          const float t = pixel.depth + reach * (2 * static_cast<float>(i) / static_cast<float>(steps) - 1);
          const Vec3f place = origin + t * ray;
          if (inside.contains(place)) keys.insert_around(place, margin);
        }
      }
    }
    found[chunk] = keys.keys();
  });
  std::vector<std::uint64_t> all;
  for (const auto& keys : found) all.insert(all.end(), keys.begin(), keys.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<Index3> keys;
  keys.reserve(all.size());
  for (const std::uint64_t key : all) keys.push_back(unpacked_key(key));
  return keys;
}

void fuse(SurfaceBlocks& blocks, const SurfaceFrame& frame, const View& view, std::uint16_t number) {
  const FrameFuser fuser(frame, view, blocks.cell(), number);
  parallel_for(blocks.size(), [&](std::size_t i) { fuser.fuse(*blocks.all()[i]); });
}

}  // namespace vantage
