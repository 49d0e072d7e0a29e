#include "vantage/model/surface_volume.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/model/surface_closure.hpp"

namespace vantage {

void SurfaceOptions::validate() const {
  require(!cell || (*cell > 0 && std::isfinite(*cell)), "mesh-cell = ", cell.value_or(0), " m: must be positive");
  require(!target_accuracy || (*target_accuracy > 0 && std::isfinite(*target_accuracy)),
          "target-accuracy = ", target_accuracy.value_or(0), " m: must be positive");
  require(most_blocks >= 64, "most_blocks = ", most_blocks, ": must be at least 64");
}

SurfaceVolume::SurfaceVolume(const Box3& region, const SurfaceOptions& options) : region_(region), options_(options) {
  options.validate();
  require(!region.isEmpty(), "surface: the region is empty");
}

void SurfaceVolume::fuse(const Scan& scan, const View& view, const std::optional<SensorModel>& sensor,
                         double pose_error) {
  const auto number = static_cast<std::uint16_t>(std::min(frames_++, 65535));
  if (const auto* image = std::get_if<ImageScan>(&scan)) {
    fuse_image(image->image, view, {sensor ? *sensor : estimate_sensor(image->image), pose_error}, number);
  } else {
    fuse_points(std::get<PointScan>(scan), view, {sensor.value_or(SensorModel{}), pose_error}, number);
  }
}

SensorModel SurfaceVolume::estimate_sensor(const RangeImage& image) {
  constexpr int enough_frames = 8;
  if (frames_ <= enough_frames) estimator_.add(image);
  return estimator_.estimate().value_or(SensorModel{});
}

void SurfaceVolume::fuse_image(const RangeImage& image, const View& view, const SurfaceNoise& noise,
                               std::uint16_t number) {
  constexpr double least_sigma_in_pixels = 0.29;  // even of a perfect sensor: a place within its pixel, 1/sqrt(12)
  if (!blocks_) {
    const auto spacing = pixel_spacing(image, view, region_);
    if (!spacing) return;
    least_sigma_ = least_sigma_in_pixels * *spacing;
    const double sigma = noise.sigma((view.position() - region_.center()).norm());
    blocks_.emplace(options_.cell.value_or(std::max(*spacing, sigma)));
  }
  const SurfaceFrame frame(image, {noise.sensor, std::hypot(noise.pose, least_sigma_)});
  const std::size_t before =
      make_blocks(*blocks_, [&](double cell) { return blocks_near(frame, view, cell, region_); });
  vantage::fuse(*blocks_, frame, view, number);
  blocks_->drop_untouched(before);
}

void SurfaceVolume::fuse_points(const PointScan& scan, const View& view, const SurfaceNoise& noise,
                                std::uint16_t number) {
  const SurfacePoints points(scan, view, noise, region_);
  if (points.empty()) return;
  if (!blocks_) blocks_.emplace(options_.cell.value_or(std::max(points.spacing(), points.sigma())));
  const std::size_t before = make_blocks(*blocks_, [&](double cell) { return blocks_near(points, cell, region_); });
  vantage::fuse(*blocks_, points, region_, number);
  blocks_->drop_untouched(before);
}

std::size_t SurfaceVolume::make_blocks(SurfaceBlocks& blocks,
                                       const std::function<std::vector<Index3>(double)>& keys_at) const {
  std::vector<Index3> keys = keys_at(blocks.cell());
  while (blocks.size() + keys.size() > options_.most_blocks) {
    blocks = blocks.coarsened();
    keys = keys_at(blocks.cell());
  }
  const std::size_t before = blocks.size();
  blocks.make(keys);
  return before;
}

MeasuredMesh SurfaceVolume::mesh() const {
  if (!blocks_) return {};
  const SurfaceField field(*blocks_);
  return open_mesh(surface_net(field, region_), std::min(frames_, least_frames_of_a_part));
}

MeasuredMesh SurfaceVolume::closed_mesh(const VoxelMap& map) const {
  if (!blocks_) return {};
  const SurfaceField field = closed_field(SurfaceField(*blocks_), map);
  const Vec3 margin = Vec3::Constant(2 * field.cell());
  const Box3 box = map.grid().box(map.enclosure());
  return vantage::closed_mesh(surface_net(field, {box.min() - margin, box.max() + margin}),
                              std::min(frames_, least_frames_of_a_part));
}

}  // namespace vantage
