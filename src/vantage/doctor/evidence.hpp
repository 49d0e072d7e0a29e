#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vantage/doctor/depth_map.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage {

/// What the doctor keeps of one frame.
struct FrameEvidence {
  std::string name;
  Pose world_from_sensor;   // as given
  PointCloud cloud;         // thinned out evenly, sensor frame, metres as read; no depth limit applied
  DepthMap map;             // what it saw where, z as read
  double median_depth = 0;  // distance from the sensor, metres; 0 without points
  // Shares of the pixels of a depth image; 0 for clouds, which have none.
  double unknown = 0, no_return = 0;  // the latter also where it is beyond the far limit
  double strewn = 0;                  // of the "no return" pixels: those with more hits than others around them
  bool is_masked = false;             // whether unknown pixels may be so because a mask says so
};

/// All frames of a set that have a point.
struct Evidence {
  std::vector<FrameEvidence> frames;
  std::vector<std::string> empty;     // names of those that have none
  std::optional<RangeCamera> camera;  // of depth images
  std::size_t every = 1;              // of long recordings every n-th frame is looked at

  [[nodiscard]] std::vector<Pose> poses() const;
  /// Over all frames.
  [[nodiscard]] double median_depth() const;
};

/// Reads every frame once, of more than 300 every second, third ... one, so that memory and time do not grow with
/// their number. `far_limit`: depth in metres from which on an image says that nothing is there. What lies
/// outside of the crop box of `options` is left out of the points, but counts as the sensor reported it.
/// `progress(done, of)` is called after each.
[[nodiscard]] Evidence gather(const ScanSet& set, double far_limit, const ScanFolderOptions& options,
                              const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace vantage
