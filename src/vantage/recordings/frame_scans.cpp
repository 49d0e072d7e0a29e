#include "vantage/recordings/frame_scans.hpp"

#include <fmt/format.h>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/recordings/read_ahead.hpp"
#include "vantage/recordings/scan_bytes.hpp"

namespace vantage {
namespace {

/// The camera of a frame; nothing for clouds.
std::optional<RangeCamera> camera_of(const Frame& frame, const ScanFolderOptions& options) {
  const auto* pixels = std::get_if<DepthPixels>(&frame.measured);
  if (pixels == nullptr) return std::nullopt;
  require(frame.intrinsics.has_value(), "frame ", in_quotes(frame.info.name), ": has no intrinsics; give --intrinsics");
  RangeCamera camera =
      pinhole_camera(*frame.intrinsics, std::visit([](const auto& image) { return image.resolution; }, *pixels));
  camera.min_depth = options.depth_range[0];
  camera.max_depth = options.depth_range[1];
  return camera;
}

/// Errors of reading with the frame's name before them.
template <class Read>
auto naming(const std::string& frame, const Read& read) {
  try {
    return read();
  } catch (const ResolutionError& error) {
    throw ResolutionError(fmt::format("frame {}: {}", in_quotes(frame), error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("frame {}: {}", in_quotes(frame), error.what()));
  }
}

Scan scan_of_frame(const Frame& frame, const View& view, const ScanFolderOptions& options) {
  ScanFolderOptions used = options;
  if (!used.depth_scale) used.depth_scale = frame.metres_per_unit;
  return naming(frame.info.name, [&] {
    if (const auto* cloud = std::get_if<CloudFile>(&frame.measured))
      return cropped(scan_of_cloud(*cloud, view.world_from_sensor, used), view, used);
    require(frame.intrinsics.has_value(), "has no intrinsics; give --intrinsics");
    return scan_of_depth(std::get<DepthPixels>(frame.measured), *frame.intrinsics, frame.mask, view, used);
  });
}

}  // namespace

ScanSet scans_of(const std::shared_ptr<FrameSource>& source, const ScanFolderOptions& options) {
  ScanSet set;
  set.description = source->description();
  set.left_out = source->left_out();
  const Pose hand_eye = hand_eye_offset(options);
  const bool is_masked = !options.masks.empty() || !options.confidence.empty();
  for (std::size_t i = 0; i < source->frames().size(); ++i) {
    const FrameInfo& info = source->frames()[i];
    if (!info.world_from_sensor) {
      set.left_out.push_back(fmt::format("frame {} has no pose", in_quotes(info.name)));
      continue;
    }
    const View view{sensor_pose(*info.world_from_sensor, hand_eye, options)};
    // The camera is known from the first frame, which is kept until it is asked for.
    std::shared_ptr<ReadAhead<Frame>> first;
    if (set.scans.empty()) {
      Frame frame = naming(info.name, [&] { return source->read(i); });
      set.camera = naming(info.name, [&] { return camera_of(frame, options); });
      first = std::make_shared<ReadAhead<Frame>>(std::move(frame));
    }
    set.scans.push_back({as_utf8(info.name), view,
                         [source, i, view, options, first] {
                           std::optional<Frame> frame = first ? first->take() : std::nullopt;
                           return scan_of_frame(frame ? *frame : source->read(i), view, options);
                         },
                         is_masked});
  }
  require(!set.scans.empty(), set.description, ": no frame has a pose; give a trajectory with --poses");
  return set;
}

}  // namespace vantage
