#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "vantage/formats/camera_file.hpp"
#include "vantage/recordings/bag_index.hpp"

namespace vantage {

/// What to take from a bag. Empty texts: what its messages suggest.
struct BagOptions {
  std::string topic = "";       // depth images or clouds
  std::string frame = "";       // the world: a frame of /tf
  std::string poses = "";       // a topic with poses, or a trajectory file (TUM)
  std::string intrinsics = "";  // a file instead of the topic camera_info
  int every = 1;                // takes every n-th frame

  /// Throws InputError naming the option.
  void validate() const;
};

/// Whether the topic has depth images or clouds.
[[nodiscard]] bool has_depth(const TopicIndex& topic);

/// The topic with depth images or clouds: the one of the options, or the only one, or of several that show the same the
/// one that others are made from (images rather than clouds, images rather than their packed copies, rectified rather
/// than raw). Throws InputError naming the candidates where that is not one.
[[nodiscard]] const TopicIndex& choose_frames(const BagIndex& index, const BagOptions& options,
                                              const std::string& name);

/// Where the intrinsics of depth images are from; none for clouds. Throws InputError naming what is missing.
struct ChosenIntrinsics {
  std::optional<Intrinsics> intrinsics;
  std::string source;
};
[[nodiscard]] ChosenIntrinsics choose_intrinsics(const BagIndex& index, const TopicIndex& frames,
                                                 const BagOptions& options, const std::string& name);

/// Where the poses of the sensor are from: /tf, a topic with poses, or a file; nothing where there are none.
struct ChosenPoses {
  std::function<PoseOrReason(std::int64_t time_ns)> world_from_sensor;  // empty where the bag has no poses
  std::string source;                                                   // in words
  std::string frame = "";                                               // the world's
};
/// Throws InputError naming the option, or the candidates where several would do. The index must outlive what is
/// returned.
[[nodiscard]] ChosenPoses choose_poses(const BagIndex& index, const TopicIndex& frames, const BagOptions& options,
                                       const std::string& name);

/// Whether images of this topic are rectified, by its name.
[[nodiscard]] bool is_rectified(const std::string& topic);

}  // namespace vantage
