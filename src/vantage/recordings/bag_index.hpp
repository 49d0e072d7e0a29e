#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vantage/recordings/bag.hpp"
#include "vantage/recordings/pose_track.hpp"
#include "vantage/recordings/ros_messages.hpp"
#include "vantage/recordings/transform_tree.hpp"

namespace vantage {

/// What the messages of a topic are to us.
enum class TopicKind {
  other,
  depth,
  packed_depth,
  cloud,
  color,
  packed_color,
  camera_info,
  transforms,
  pose,
  depth_unit
};

/// A message with pixels or points, to be decoded later.
struct RecordedFrame {
  MessagePlace place;
  std::int64_t time_ns = 0;  // when it was taken; where the sensor did not say so, when it was recorded
};

/// What is known of a topic after one pass over a bag.
struct TopicIndex {
  BagTopic topic;
  TopicKind kind = TopicKind::other;
  std::uint64_t messages = 0;
  std::int64_t first_ns = 0, last_ns = 0;  // recorded
  std::string content;                     // "640x480 16UC1", of images and clouds
  std::string frame_id;                    // of the first message
  std::vector<RecordedFrame> frames;       // of depth, clouds and colour, by time
  std::optional<RosCameraInfo> camera;     // the first one
  std::uint64_t other_cameras = 0;         // messages with other intrinsics than the first one
  PoseTrack track;                         // of poses
  std::string child;                       // whose poses they are, where the messages say so
  std::optional<double> metres_per_unit;   // of depth images of RealSense recordings
  std::uint64_t unreadable = 0;            // messages that contradict themselves
  std::string first_trouble;

  [[nodiscard]] double rate_hz() const;
  [[nodiscard]] bool is_readable() const { return topic.encoding == "cdr" || topic.encoding == "ros1"; }
};

/// All that is needed of a bag but pixels and points.
struct BagIndex {
  std::vector<TopicIndex> topics;
  TransformTree transforms;

  [[nodiscard]] const TopicIndex* find(const std::string& topic) const;
};

/// Reads the bag once from its beginning to its end.
[[nodiscard]] BagIndex index_bag(Bag& bag);

/// How the messages of the topic are serialised.
[[nodiscard]] Serialization serialization_of(const BagTopic& topic);

}  // namespace vantage
