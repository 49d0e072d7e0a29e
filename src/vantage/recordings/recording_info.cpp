#include "vantage/recordings/recording_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// Names in a bag may hold anything, also what a terminal takes for commands.
std::string without_controls(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, '?');
  return text;
}

RecordingInfo::Topic info_of(const TopicIndex& topic) {
  return {without_controls(topic.topic.name),
          without_controls(topic.topic.type),
          without_controls(topic.topic.encoding),
          topic.messages,
          topic.rate_hz(),
          without_controls(topic.content),
          without_controls(topic.frame_id)};
}

double duration_of(const BagIndex& index) {
  std::int64_t first = std::numeric_limits<std::int64_t>::max(), last = 0;
  for (const TopicIndex& topic : index.topics) {
    if (topic.messages == 0) continue;
    first = std::min(first, topic.first_ns);
    last = std::max(last, topic.last_ns);
  }
  return last > first ? 1e-9 * static_cast<double>(last - first) : 0;
}

RecordingInfo::Source source_of(const BagIndex& index, const TopicIndex& topic, const std::string& name) {
  RecordingInfo::Source source{without_controls(topic.topic.name), "", {}};
  const BagOptions options{.topic = topic.topic.name};
  try {
    const ChosenIntrinsics intrinsics = choose_intrinsics(index, topic, options, name);
    const ChosenPoses poses = choose_poses(index, topic, options, name);
    source.reading = poses.source.empty() ? "no poses; give a trajectory with --poses" : "poses from " + poses.source;
    if (!intrinsics.source.empty()) source.reading += ", intrinsics from " + intrinsics.source;
    source.options = {"--topic", source.topic};
    if (!poses.frame.empty()) source.options.insert(source.options.end(), {"--frame", without_controls(poses.frame)});
    if (poses.source.empty()) source.options.insert(source.options.end(), {"--poses", "TRAJECTORY.txt"});
  } catch (const InputError& error) {
    source.reading = error.what();
  }
  source.reading = without_controls(source.reading);
  return source;
}

/// The topic that is read when nobody chooses one; empty where one has to be chosen.
std::string default_topic(const BagIndex& index, const std::string& name) {
  try {
    return choose_frames(index, {}, name).topic.name;
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

RecordingInfo recording_info(const std::filesystem::path& path) {
  const std::unique_ptr<Bag> bag = open_bag(path);
  const BagIndex index = index_bag(*bag);
  RecordingInfo info;
  info.duration_s = duration_of(index);
  info.format = bag->format();
  const std::string preferred = default_topic(index, path.string());
  for (const TopicIndex& topic : index.topics) {
    info.topics.push_back(info_of(topic));
    if (topic.unreadable > 0)
      info.damage.push_back(
          without_controls(fmt::format("{} messages cannot be read: {}", topic.unreadable, topic.first_trouble)));
    if (!has_depth(topic)) continue;
    const auto place = topic.topic.name == preferred ? info.sources.begin() : info.sources.end();
    info.sources.insert(place, source_of(index, topic, path.string()));
  }
  std::sort(info.topics.begin(), info.topics.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  for (const std::string& line : index.transforms.drawing()) info.frames.push_back(without_controls(line));
  for (const std::string& line : bag->damage()) info.damage.push_back(without_controls(line));
  return info;
}

}  // namespace vantage
