#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/pose_file.hpp"
#include "vantage/recordings/bag_choice.hpp"

namespace vantage {
namespace {

/// The sensor's frame, as /tf has it.
struct SensorFrame {
  std::string name;  // empty where /tf does not have it
  Pose frame_from_sensor = Pose::Identity();
  std::string note;
};

/// The axes of a camera's image (z forward) in those of its housing (x forward, z up), by REP 103.
Pose link_from_optical() {
  Pose pose = Pose::Identity();
  pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return pose;
}

SensorFrame sensor_frame(const TransformTree& tree, const std::string& frame_id) {
  if (tree.knows(frame_id)) return {frame_id, Pose::Identity(), ""};
  for (const std::string_view ending : {"_optical_frame", "_optical_link", "_optical"}) {
    if (frame_id.size() <= ending.size() || !frame_id.ends_with(ending)) continue;
    const std::string base = frame_id.substr(0, frame_id.size() - ending.size());
    for (const char* other : {"_frame", "_link", ""}) {
      if (!tree.knows(base + other)) continue;
      return {base + other, link_from_optical(),
              fmt::format("; /tf has no {}, taken for {} with the axes of its images", frame_id, base + other)};
    }
  }
  return {};
}

PoseOrReason pose_of_track(const PoseTrack& track, std::int64_t time_ns) {
  const auto [sample, reason] = track.at(time_ns);
  if (!sample) return {std::nullopt, reason};
  return {sample->pose(), ""};
}

ChosenPoses poses_from_file(const std::string& path) {
  auto track = std::make_shared<PoseTrack>();
  for (const StampedPose& stamped : read_trajectory(path)) {
    constexpr double most = 4e9;  // seconds
    require(std::abs(stamped.time) < most, path, ": time ", stamped.time, " s: must be below ", most);
    track->add(static_cast<std::int64_t>(std::llround(stamped.time * 1e9)), 0, stamped.pose);
  }
  track->finish();
  return {[track](std::int64_t time_ns) { return pose_of_track(*track, time_ns); }, path, ""};
}

ChosenPoses poses_from_tree(const TransformTree& tree, const SensorFrame& sensor, const std::string& world) {
  const auto at = [&tree, sensor, world](std::int64_t time_ns) {
    PoseOrReason pose = tree.a_from_b(world, sensor.name, time_ns);
    if (pose.pose) pose.pose = *pose.pose * sensor.frame_from_sensor;
    return pose;
  };
  return {at, fmt::format("/tf ({} in {}{})", sensor.name, world, sensor.note), world};
}

/// The poses of a topic, carried on by /tf from the body that they are of to the sensor where that is known.
ChosenPoses poses_from_topic(const TransformTree& tree, const TopicIndex& topic, const SensorFrame& sensor,
                             const std::string& world) {
  require(world.empty() || world == topic.frame_id || (tree.knows(world) && tree.knows(topic.frame_id)),
          "frame = ", in_quotes(world), ": the poses of ", topic.topic.name, " are in ", topic.frame_id,
          ", which /tf does not connect to it");
  const bool is_body =
      !topic.child.empty() && !sensor.name.empty() && tree.knows(topic.child) && topic.child != sensor.name;
  const bool is_elsewhere = !world.empty() && world != topic.frame_id;
  const auto at = [&tree, &topic, sensor, world, is_body, is_elsewhere](std::int64_t time_ns) {
    PoseOrReason result = pose_of_track(topic.track, time_ns);
    if (result.pose && is_body) {
      const PoseOrReason on = tree.a_from_b(topic.child, sensor.name, time_ns);
      if (!on.pose) return on;
      result.pose = *result.pose * *on.pose * sensor.frame_from_sensor;
    }
    if (result.pose && is_elsewhere) {
      const PoseOrReason from = tree.a_from_b(world, topic.frame_id, time_ns);
      if (!from.pose) return from;
      result.pose = *from.pose * *result.pose;
    }
    return result;
  };
  const std::string whose = is_body ? fmt::format(" of {}, on to {} by /tf{}", topic.child, sensor.name, sensor.note)
                                    : std::string(", taken for the sensor's");
  const std::string in = world.empty() ? topic.frame_id : world;
  return {at, fmt::format("{} (in {}{})", topic.topic.name, in.empty() ? "no frame" : in, whose), in};
}

std::vector<const TopicIndex*> pose_topics(const BagIndex& index) {
  std::vector<const TopicIndex*> topics;
  for (const TopicIndex& topic : index.topics) {
    if (topic.kind == TopicKind::pose && topic.track.size() > 0) topics.push_back(&topic);
  }
  return topics;
}

}  // namespace

ChosenPoses choose_poses(const BagIndex& index, const TopicIndex& frames, const BagOptions& options,
                         const std::string& name) {
  const TransformTree& tree = index.transforms;
  const std::vector<const TopicIndex*> topics = pose_topics(index);
  const SensorFrame sensor = sensor_frame(tree, frames.frame_id);
  if (!options.poses.empty()) {
    const auto chosen = std::find_if(topics.begin(), topics.end(),
                                     [&](const TopicIndex* each) { return each->topic.name == options.poses; });
    if (chosen != topics.end()) return poses_from_topic(tree, **chosen, sensor, options.frame);
    require(options.poses.front() != '/' || std::filesystem::exists(options.poses),
            "poses = ", in_quotes(options.poses), ": is no file, and ", name, " has no poses of that name");
    return poses_from_file(options.poses);
  }
  require(options.frame.empty() || tree.knows(options.frame) ||
              std::any_of(topics.begin(), topics.end(),
                          [&](const TopicIndex* each) { return each->frame_id == options.frame; }),
          "frame = ", in_quotes(options.frame), ": ", name, " has no such frame; see `vantage recording info`");
  const std::string root = sensor.name.empty() ? "" : tree.root_of(sensor.name).value_or("");
  const std::string world = options.frame.empty() ? root : options.frame;
  const bool is_in_tree = !sensor.name.empty() && world != sensor.name && tree.knows(world);
  if (is_in_tree && (topics.empty() || tree.moves(sensor.name))) return poses_from_tree(tree, sensor, world);
  if (topics.empty()) return {};
  if (topics.size() > 1) {
    std::vector<std::string> names;
    for (const TopicIndex* each : topics) names.push_back(each->topic.name);
    throw InputError(
        fmt::format("{}: /tf does not move {}, and there are several topics with poses; choose one with "
                    "--poses: {}",
                    name, frames.frame_id.empty() ? "the sensor" : frames.frame_id, fmt::join(names, ", ")));
  }
  return poses_from_topic(tree, *topics.front(), sensor, options.frame);
}

}  // namespace vantage
