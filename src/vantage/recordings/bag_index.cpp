#include "vantage/recordings/bag_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "vantage/core/error.hpp"
#include "vantage/recordings/ros_image.hpp"

namespace vantage {
namespace {

bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

/// The kind by the type, as far as it says so; images need a look at the first message.
TopicKind kind_of(const BagTopic& topic) {
  if (topic.type == "sensor_msgs/PointCloud2") return TopicKind::cloud;
  if (topic.type == "sensor_msgs/CameraInfo") return TopicKind::camera_info;
  if (topic.type == "tf2_msgs/TFMessage" || topic.type == "tf/tfMessage") return TopicKind::transforms;
  if (is_pose_type(topic.type)) return TopicKind::pose;
  const bool is_unit = contains(topic.name, "option/Depth") && contains(topic.name, "Units/value");
  return topic.type == "std_msgs/Float32" && is_unit ? TopicKind::depth_unit : TopicKind::other;
}

/// Dates beyond the year 2116 are mistakes, and differences of times must fit into 64 bits.
std::int64_t plausible(std::int64_t time_ns) {
  constexpr std::int64_t latest = std::numeric_limits<std::int64_t>::max() / 2;
  return std::clamp<std::int64_t>(time_ns, 0, latest);
}

bool is_same_camera(const RosCameraInfo& a, const RosCameraInfo& b) {
  return a.k == b.k && a.p == b.p && a.distortion == b.distortion && a.width == b.width && a.height == b.height;
}

/// Takes in one message after the other.
class Indexer {
 public:
  explicit Indexer(const Bag& bag) : bag_(&bag) {}

  void add(const BagMessage& message) {
    TopicIndex& topic = entry(message.topic);
    const std::int64_t time = plausible(message.time_ns);
    topic.first_ns = topic.messages == 0 ? time : std::min(topic.first_ns, time);
    topic.last_ns = topic.messages == 0 ? time : std::max(topic.last_ns, time);
    ++topic.messages;
    if (!topic.is_readable()) return;
    try {
      MessageReader reader(message.bytes, serialization_of(topic.topic),
                           fmt::format("{}, message {}", topic.topic.name, topic.messages - 1));
      take(topic, reader, message, time);
    } catch (const InputError& error) {
      if (++topic.unreadable == 1) topic.first_trouble = error.what();
    }
  }

  BagIndex finish() {
    for (std::size_t i = 0; i < bag_->topics().size(); ++i) (void)entry(i);
    for (TopicIndex& topic : index_.topics) {
      std::stable_sort(topic.frames.begin(), topic.frames.end(),
                       [](const RecordedFrame& a, const RecordedFrame& b) { return a.time_ns < b.time_ns; });
      topic.track.finish();
    }
    index_.transforms.finish();
    return std::move(index_);
  }

 private:
  TopicIndex& entry(std::size_t topic) {
    while (index_.topics.size() <= topic) {
      const BagTopic& next = bag_->topics()[index_.topics.size()];
      TopicIndex made;
      made.topic = next;
      made.kind = kind_of(next);
      index_.topics.push_back(std::move(made));
    }
    return index_.topics[topic];
  }

  void take(TopicIndex& topic, MessageReader& reader, const BagMessage& message, std::int64_t time) {
    const std::string& type = topic.topic.type;
    if (type == "sensor_msgs/Image" || type == "sensor_msgs/CompressedImage" || type == "sensor_msgs/PointCloud2") {
      take_frame(topic, reader, message, time);
    } else if (topic.kind == TopicKind::camera_info) {
      const RosCameraInfo info = read_camera_info(reader);
      if (!topic.camera) topic.camera = info;
      if (topic.frame_id.empty()) topic.frame_id = info.header.frame_id;
      if (!is_same_camera(*topic.camera, info)) ++topic.other_cameras;
    } else if (topic.kind == TopicKind::transforms) {
      take_transforms(topic, reader, time);
    } else if (topic.kind == TopicKind::pose) {
      const RosPose pose = read_pose_message(reader, type);
      if (topic.track.size() == 0) topic.frame_id = pose.header.frame_id;
      if (topic.track.size() == 0) topic.child = pose.child;
      topic.track.add(pose.header.stamp_ns != 0 ? pose.header.stamp_ns : time, 0, pose.parent_from_child);
    } else if (topic.kind == TopicKind::depth_unit) {
      topic.metres_per_unit = static_cast<double>(reader.f32());
    }
  }

  void take_transforms(const TopicIndex& topic, MessageReader& reader, std::int64_t time) {
    const bool is_static = topic.topic.name.ends_with("tf_static");
    for (const RosPose& transform : read_transforms(reader)) {
      if (transform.child == transform.header.frame_id) continue;
      if (is_static) {
        index_.transforms.add_static(transform);
      } else {
        index_.transforms.add(transform, transform.header.stamp_ns != 0 ? transform.header.stamp_ns : time);
      }
    }
  }

  static void take_frame(TopicIndex& topic, MessageReader& reader, const BagMessage& message, std::int64_t time) {
    const MessageReader from_begin = reader;
    const RosHeader header = read_header(reader);
    if (topic.content.empty()) {
      MessageReader again = from_begin;
      describe(topic, again);
      topic.frame_id = header.frame_id;
    }
    if (topic.kind != TopicKind::other)
      topic.frames.push_back({message.place, header.stamp_ns != 0 ? header.stamp_ns : time});
  }

  /// What the first message of a topic with images or clouds says about all of them.
  static void describe(TopicIndex& topic, MessageReader& reader) {
    if (topic.topic.type == "sensor_msgs/Image") {
      const RosImage image = read_image(reader);
      topic.content = fmt::format("{}x{} {}", image.width, image.height, image.encoding);
      if (is_depth_encoding(image.encoding)) topic.kind = TopicKind::depth;
      if (is_color_encoding(image.encoding)) topic.kind = TopicKind::color;
    } else if (topic.topic.type == "sensor_msgs/CompressedImage") {
      const RosCompressedImage image = read_compressed_image(reader);
      topic.content = image.format.empty() ? "compressed" : image.format;
      const bool is_depth = contains(image.format, "compressedDepth") || contains(image.format, "16UC1");
      topic.kind = is_depth ? TopicKind::packed_depth : TopicKind::packed_color;
    } else {
      const RosPointCloud cloud = read_point_cloud(reader);
      topic.content = fmt::format("{}x{} points", cloud.width, cloud.height);
    }
  }

  const Bag* bag_;
  BagIndex index_;
};

}  // namespace

double TopicIndex::rate_hz() const {
  return last_ns > first_ns ? static_cast<double>(messages - 1) / (1e-9 * static_cast<double>(last_ns - first_ns)) : 0;
}

const TopicIndex* BagIndex::find(const std::string& topic) const {
  const auto found =
      std::find_if(topics.begin(), topics.end(), [&](const TopicIndex& each) { return each.topic.name == topic; });
  return found == topics.end() ? nullptr : &*found;
}

BagIndex index_bag(Bag& bag) {
  Indexer indexer(bag);
  bag.walk([&](const BagMessage& message) { indexer.add(message); });
  return indexer.finish();
}

Serialization serialization_of(const BagTopic& topic) {
  return topic.encoding == "ros1" ? Serialization::ros1 : Serialization::cdr;
}

}  // namespace vantage
