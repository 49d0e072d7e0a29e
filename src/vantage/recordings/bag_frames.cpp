#include "vantage/recordings/bag_frames.hpp"

#include <fmt/format.h>

#include <mutex>

#include "vantage/core/error.hpp"
#include "vantage/recordings/ros_image.hpp"

namespace vantage {
namespace {

class BagFrames : public FrameSource {
 public:
  BagFrames(const std::filesystem::path& path, const BagOptions& options)
      : name_(path.string()), bag_(open_bag(path)), index_(index_bag(*bag_)) {
    options.validate();
    topic_ = &choose_frames(index_, options, name_);
    intrinsics_ = choose_intrinsics(index_, *topic_, options, name_);
    poses_ = choose_poses(index_, *topic_, options, name_);
    for (const TopicIndex& each : index_.topics) {
      if (each.metres_per_unit && *each.metres_per_unit > 0) metres_per_unit_ = each.metres_per_unit;
    }
    place_frames(static_cast<std::size_t>(options.every));
    note_trouble();
  }

  const std::vector<FrameInfo>& frames() const override { return frames_; }

  Frame read(std::size_t index) override {
    require(index < frames_.size(), name_, ": frame ", index, " is asked for, there are ", frames_.size());
    Frame frame;
    frame.info = frames_[index];
    const std::string name = fmt::format("{}, {} of {}", name_, frame.info.name, topic_->topic.name);
    std::string bytes;
    {
      const std::lock_guard lock(mutex_);
      bytes = bag_->read(topic_->frames[numbers_[index]].place);
    }
    MessageReader reader(bytes, serialization_of(topic_->topic), name);
    if (topic_->kind == TopicKind::cloud) {
      frame.measured = cloud_of(read_point_cloud(reader), name);
    } else {
      frame.measured = topic_->kind == TopicKind::depth ? depth_of(read_image(reader), name)
                                                        : depth_of(read_compressed_image(reader), name);
      frame.intrinsics = intrinsics_.intrinsics;
      frame.metres_per_unit = metres_per_unit_;
    }
    return frame;
  }

  std::string description() const override {
    const bool are_clouds = topic_->kind == TopicKind::cloud;
    std::string text = fmt::format("{}: {} {} of {} ({})", bag_->format(), frames_.size(),
                                   are_clouds ? "clouds" : "depth images", topic_->topic.name, topic_->content);
    text += poses_.source.empty() ? ", no poses" : ", poses from " + poses_.source;
    if (!intrinsics_.source.empty()) text += ", intrinsics from " + intrinsics_.source;
    return text;
  }

  std::vector<std::string> left_out() const override { return left_out_; }

 private:
  /// Frames without a pose are left out where others have one.
  void place_frames(std::size_t every) {
    std::string reason, first, last;
    std::size_t count = 0;
    const auto note = [&] {
      if (count == 1) left_out_.push_back(fmt::format("{}: has no pose: {}", first, reason));
      if (count > 1)
        left_out_.push_back(fmt::format("{} to {} ({} frames): have no pose: {}", first, last, count, reason));
      count = 0;
    };
    for (std::size_t i = 0; i < topic_->frames.size(); i += every) {
      const std::int64_t time = topic_->frames[i].time_ns;
      FrameInfo info{fmt::format("frame-{:06}", i), 1e-9 * static_cast<double>(time), std::nullopt};
      if (poses_.world_from_sensor) {
        const PoseOrReason pose = poses_.world_from_sensor(time);
        if (!pose.pose) {
          if (count == 0) first = info.name, reason = pose.reason;
          last = info.name;
          ++count;
          continue;
        }
        info.world_from_sensor = pose.pose;
      }
      note();
      numbers_.push_back(i);
      frames_.push_back(std::move(info));
    }
    note();
    require(!frames_.empty(), name_, ": no frame of ", topic_->topic.name, " has a pose; ",
            left_out_.empty() ? "" : left_out_.front());
  }

  void note_trouble() {
    for (const std::string& line : bag_->damage()) left_out_.push_back(line);
    for (const TopicIndex& topic : index_.topics) {
      if (topic.unreadable > 0)
        left_out_.push_back(fmt::format("{} messages cannot be read: {}", topic.unreadable, topic.first_trouble));
    }
    const TopicIndex* camera = index_.find(intrinsics_.source);
    if (camera != nullptr && camera->other_cameras > 0)
      left_out_.push_back(fmt::format("{}: {} messages have other intrinsics than the first one, which is used",
                                      camera->topic.name, camera->other_cameras));
  }

  std::string name_;
  std::unique_ptr<Bag> bag_;
  std::mutex mutex_;  // of the bag
  BagIndex index_;
  const TopicIndex* topic_ = nullptr;
  ChosenIntrinsics intrinsics_;
  ChosenPoses poses_;
  std::optional<double> metres_per_unit_;
  std::vector<std::size_t> numbers_;  // of the frames, among the messages of the topic
  std::vector<FrameInfo> frames_;
  std::vector<std::string> left_out_;
};

}  // namespace

std::unique_ptr<FrameSource> open_bag_frames(const std::filesystem::path& path, const BagOptions& options) {
  return std::make_unique<BagFrames>(path, options);
}

}  // namespace vantage
