#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "vantage/core/geometry.hpp"
#include "vantage/recordings/pose_track.hpp"
#include "vantage/recordings/ros_messages.hpp"

namespace vantage {

/// A pose, or why there is none.
struct PoseOrReason {
  std::optional<Pose> pose;
  std::string reason;
};

/// The tree of frames that /tf and /tf_static describe, over time.
class TransformTree {
 public:
  /// A transform of /tf, or of /tf_static, which holds for all times.
  void add(const RosPose& transform, std::int64_t time_ns);
  void add_static(const RosPose& transform);
  /// To be called once, after the last add().
  void finish();

  [[nodiscard]] bool empty() const { return numbers_.empty(); }
  [[nodiscard]] bool knows(const std::string& frame) const { return numbers_.count(frame) == 1; }
  /// The frame at the top of the tree that this frame is in; nothing where the frame is unknown.
  [[nodiscard]] std::optional<std::string> root_of(const std::string& frame) const;
  /// Whether anything between the frame and the root moves.
  [[nodiscard]] bool moves(const std::string& frame) const;
  /// a_from_b at this time, through their nearest common parent.
  [[nodiscard]] PoseOrReason a_from_b(const std::string& a, const std::string& b, std::int64_t time_ns) const;
  /// The tree as lines, children indented below their parents, with the number of samples.
  [[nodiscard]] std::vector<std::string> drawing() const;

 private:
  struct Edge {
    std::optional<PoseTrack::Sample> fixed;
    PoseTrack moving;  // counts where it has samples
    [[nodiscard]] std::optional<std::uint32_t> parent() const;
  };
  /// A frame that is met on going up from another one.
  struct Step {
    std::uint32_t frame = 0;
    Pose frame_from_start = Pose::Identity();  // start: where the chain begins
  };
  struct Chain {
    std::vector<Step> steps;  // from the frame itself up
    std::string reason;       // why it ends, where it is not at a root
  };

  std::uint32_t number(const std::string& frame);
  [[nodiscard]] Chain chain(std::uint32_t frame, std::int64_t time_ns) const;
  [[nodiscard]] std::vector<std::uint32_t> ancestors(std::uint32_t frame) const;
  void draw(std::uint32_t frame, std::size_t depth, std::vector<std::string>& lines) const;

  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
  std::vector<Edge> edges_;  // of each frame to its parent
};

}  // namespace vantage
