#include "vantage/recordings/frame_scans.hpp"

#include <fmt/format.h>

#include "vantage/core/error.hpp"
#include "vantage/recordings/scan_bytes.hpp"

namespace vantage {
namespace {

/// The options for this frame: what the recording says about its unit counts where the options leave it open.
ScanFolderOptions options_for(const Frame& frame, ScanFolderOptions options) {
  if (frame.metres_per_unit && options.depth_scale == ScanFolderOptions().depth_scale)
    options.depth_scale = *frame.metres_per_unit;
  return options;
}

Scan scan_of_frame(const Frame& frame, const View& view, const ScanFolderOptions& options) {
  if (const auto* cloud = std::get_if<CloudFile>(&frame.measured))
    return scan_of_cloud(*cloud, view.world_from_sensor, options);
  require(frame.intrinsics.has_value(), frame.info.name, ": has no intrinsics; give a file with --intrinsics");
  return scan_of_depth(std::get<DepthPixels>(frame.measured), *frame.intrinsics, frame.mask,
                       options_for(frame, options));
}

/// The camera of depth images.
std::optional<RangeCamera> camera_of(const Frame& frame, const ScanFolderOptions& options) {
  const auto* pixels = std::get_if<DepthPixels>(&frame.measured);
  if (pixels == nullptr || !frame.intrinsics) return std::nullopt;
  const Resolution resolution = std::visit([](const auto& image) { return image.resolution; }, *pixels);
  RangeCamera camera = pinhole_camera(*frame.intrinsics, resolution);
  camera.min_depth = options.depth_range[0];
  camera.max_depth = options.depth_range[1];
  return camera;
}

}  // namespace

ScanSet scans_of(const std::shared_ptr<FrameSource>& frames, const ScanFolderOptions& options) {
  ScanSet set;
  set.description = frames->description();
  set.left_out = frames->left_out();
  const Pose hand_eye = hand_eye_offset(options);
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < frames->frames().size(); ++i) {
    const FrameInfo& info = frames->frames()[i];
    if (!info.world_from_sensor) {
      set.left_out.push_back(info.name + ": has no pose");
      continue;
    }
    if (!first) first = i;
    const View view{sensor_pose(*info.world_from_sensor, hand_eye, options)};
    set.scans.push_back({info.name, view, [frames, i, view, options] {
                           return cropped(scan_of_frame(frames->read(i), view, options), view, options);
                         }});
  }
  require(first.has_value(), set.description, ": no frame has a pose; give a trajectory with --poses");
  set.camera = camera_of(frames->read(*first), options);
  return set;
}

}  // namespace vantage
