#include "vantage/recordings/bag_choice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/recordings/ros_image.hpp"

namespace vantage {
namespace {

std::string topic_names(const std::vector<const TopicIndex*>& topics) {
  std::vector<std::string> names;
  for (const TopicIndex* topic : topics) names.push_back(topic->topic.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string topic_above(const std::string& topic) { return topic.substr(0, topic.find_last_of('/')); }

/// The topic that the packed copies of a transport are made from: /camera/depth/image_raw of .../compressedDepth.
std::string unpacked_name(const std::string& topic) {
  return topic.ends_with("/compressedDepth") || topic.ends_with("/compressed") ? topic_above(topic) : topic;
}

/// Those that no other one of them is better than.
std::vector<const TopicIndex*> without_copies(const std::vector<const TopicIndex*>& all) {
  const auto is_copy_of = [](const TopicIndex& copy, const TopicIndex& other) {
    if (copy.kind == TopicKind::cloud) return other.kind != TopicKind::cloud;
    if (other.kind == TopicKind::cloud) return false;
    const std::string copied = unpacked_name(copy.topic.name), kept = unpacked_name(other.topic.name);
    if (copied == kept) return copy.kind == TopicKind::packed_depth && other.kind == TopicKind::depth;
    return topic_above(copied) == topic_above(kept) && !is_rectified(copied) && is_rectified(kept);
  };
  std::vector<const TopicIndex*> left;
  for (const TopicIndex* topic : all) {
    const bool is_copy = std::any_of(
        all.begin(), all.end(), [&](const TopicIndex* other) { return other != topic && is_copy_of(*topic, *other); });
    if (!is_copy) left.push_back(topic);
  }
  return left;
}

std::string readable_kinds(const BagIndex& index) {
  std::vector<std::string> names;
  for (const TopicIndex& topic : index.topics)
    names.push_back(fmt::format("{} ({})", topic.topic.name, topic.topic.type));
  if (names.size() > 12) {
    names.resize(12);
    names.emplace_back("...");
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

bool has_depth(const TopicIndex& topic) {
  const bool is_depth = topic.kind == TopicKind::depth || topic.kind == TopicKind::packed_depth;
  return (is_depth || topic.kind == TopicKind::cloud) && !topic.frames.empty();
}

bool is_rectified(const std::string& topic) {
  const std::string name = unpacked_name(topic);
  return name.find("rect", name.find_last_of('/') + 1) != std::string::npos;
}

void BagOptions::validate() const { require(every >= 1, "every = ", every, ": must be at least 1"); }

const TopicIndex& choose_frames(const BagIndex& index, const BagOptions& options, const std::string& name) {
  std::vector<const TopicIndex*> candidates;
  for (const TopicIndex& topic : index.topics) {
    if (has_depth(topic)) candidates.push_back(&topic);
  }
  if (!options.topic.empty()) {
    const auto chosen = std::find_if(candidates.begin(), candidates.end(),
                                     [&](const TopicIndex* topic) { return topic->topic.name == options.topic; });
    require(chosen != candidates.end(), "topic = ", in_quotes(options.topic), ": ", name,
            " has no depth images or clouds of that name; must be one of ",
            candidates.empty() ? "none" : topic_names(candidates));
    return **chosen;
  }
  if (candidates.empty()) {
    const std::string topics = readable_kinds(index);
    throw InputError(
        fmt::format("{}: has no depth images and no clouds; its topics: {}", name, topics.empty() ? "none" : topics));
  }
  const std::vector<const TopicIndex*> left = without_copies(candidates);
  require(left.size() == 1, name, ": has several topics with depth; choose one with --topic: ", topic_names(left));
  return *left.front();
}

ChosenIntrinsics choose_intrinsics(const BagIndex& index, const TopicIndex& frames, const BagOptions& options,
                                   const std::string& name) {
  if (frames.kind == TopicKind::cloud) return {};
  if (!options.intrinsics.empty()) return {read_intrinsics(options.intrinsics), options.intrinsics};
  const std::string image = unpacked_name(frames.topic.name);
  std::vector<std::string> usual{topic_above(image) + "/camera_info"};
  if (image.ends_with("/image/data"))  // RealSense
    usual.push_back(image.substr(0, image.size() - std::string_view("/image/data").size()) + "/info/camera_info");
  const TopicIndex* chosen = nullptr;
  for (const std::string& topic : usual) {
    const TopicIndex* found = index.find(topic);
    if (chosen == nullptr && found != nullptr && found->camera) chosen = found;
  }
  if (chosen == nullptr) {
    // Another namespace: then the frame says which camera it is.
    std::vector<const TopicIndex*> same_frame;
    for (const TopicIndex& topic : index.topics) {
      if (topic.camera && !frames.frame_id.empty() && topic.frame_id == frames.frame_id) same_frame.push_back(&topic);
    }
    if (same_frame.size() == 1) chosen = same_frame.front();
  }
  require(chosen != nullptr, name, ": has no intrinsics for ", frames.topic.name, "; must have ",
          fmt::format("{}", fmt::join(usual, " or ")), ", or give a file with --intrinsics");
  return {intrinsics_of(*chosen->camera, is_rectified(frames.topic.name), name + ", " + chosen->topic.name),
          chosen->topic.name};
}

}  // namespace vantage
