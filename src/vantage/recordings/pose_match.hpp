#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vantage/formats/pose_list.hpp"

namespace vantage {

/// How the poses of a list belong to frames: by time, by their order, or by the numbers in the frames' names.
enum class PoseMatch { automatic, time, order, name };
[[nodiscard]] inline auto names_of(PoseMatch) {
  return std::array{
      std::pair{PoseMatch::automatic, std::string_view("auto")}, std::pair{PoseMatch::time, std::string_view("time")},
      std::pair{PoseMatch::order, std::string_view("order")}, std::pair{PoseMatch::name, std::string_view("name")}};
}

/// What is known of a frame that wants a pose.
struct FrameKey {
  std::string name;
  std::optional<double> time;  // seconds; of its name, where that is a number, if not given
};

/// A pose for each frame, where there is one.
struct MatchedPoses {
  std::vector<std::optional<Pose>> poses;
  std::vector<std::string> why_not;  // for each frame without a pose: "has no pose within 0.02 s"
  std::string how;                   // "598 matched within 20 ms"
};

/// Gives each frame its pose. Automatic: frames whose names are whole numbers go by order where there are as many
/// poses, other frames with times go by time if any is near a pose, what is left goes by order where counts agree and
/// by number where it does not. Throws InputError naming `file` where nothing matches, with what would.
[[nodiscard]] MatchedPoses match_poses(const PoseList& list, const std::vector<FrameKey>& frames, PoseMatch match,
                                       const std::string& file);

/// The last whole number in a name (frame-000150 has 150); nothing without digits.
[[nodiscard]] std::optional<std::int64_t> number_in(std::string_view name);

}  // namespace vantage
