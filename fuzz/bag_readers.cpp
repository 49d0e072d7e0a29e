#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "readers.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/compression.hpp"
#include "vantage/recordings/bag_frames.hpp"
#include "vantage/recordings/recording_info.hpp"
#include "vantage/recordings/ros_image.hpp"

namespace vantage::fuzz {
namespace {

namespace fs = std::filesystem;

/// Bags are read from files: one in a folder of its own, which is removed with it.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view bytes) {
    std::string pattern = (fs::temp_directory_path() / "vantage-fuzz-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw Error("no temporary folder");
    folder_ = pattern;
    write_file_atomically(path(), bytes);
  }
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] fs::path path() const { return folder_ / "input"; }

 private:
  fs::path folder_;
};

/// All that is done with a bag: every frame of every topic is decoded.
void read_bag(std::string_view bytes) {
  const TemporaryFile file(bytes);
  const RecordingInfo info = recording_info(file.path());
  for (const RecordingInfo::Source& source : info.sources) {
    try {
      const auto frames = open_bag_frames(file.path(), {.topic = source.topic});
      for (auto frame = frames->next(); frame; frame = frames->next()) (void)frames->description();
    } catch (const InputError&) {
      // Other topics may be good.
    }
  }
}

/// Any message, as ROS 1 and as ROS 2 would serialise it. At least one kind of message must fit.
void read_message(std::string_view bytes) {
  int accepted = 0;
  const auto attempt = [&](Serialization serialization, auto read) {
    try {
      MessageReader reader(bytes, serialization, "input");
      read(reader);
      ++accepted;
    } catch (const InputError&) {
      // Not a message of this kind.
    }
  };
  for (const Serialization each : {Serialization::ros1, Serialization::cdr}) {
    attempt(each, [](MessageReader& reader) { (void)depth_of(read_image(reader), "input"); });
    attempt(each, [](MessageReader& reader) { (void)color_of(read_image(reader), "input"); });
    attempt(each, [](MessageReader& reader) { (void)depth_of(read_compressed_image(reader), "input"); });
    attempt(each, [](MessageReader& reader) { (void)cloud_of(read_point_cloud(reader), "input"); });
    attempt(each, [](MessageReader& reader) { (void)intrinsics_of(read_camera_info(reader), true, "input"); });
    attempt(each, [](MessageReader& reader) { (void)read_transforms(reader); });
    attempt(each, [](MessageReader& reader) { (void)read_pose_message(reader, "nav_msgs/Odometry"); });
  }
  require(accepted > 0, "input: is no message that is read");
}

void read_packed(std::string_view bytes) {
  constexpr std::uint64_t limit = 1 << 20;
  std::string trouble;
  for (const auto unpack : {unpack_zstd, unpack_lz4, unpack_bzip2}) {
    const Unpacked result = unpack(bytes, limit);
    require(result.bytes.size() <= limit, "more than the limit");
    if (result.trouble.empty()) return;
    trouble = result.trouble;
  }
  throw InputError("input: " + trouble);
}

}  // namespace

const std::vector<Reader>& bag_readers() {
  static const std::vector<Reader> all{
      {"bag", "bag", read_bag},
      {"message", "message", read_message},
      {"packed", "packed", read_packed},
  };
  return all;
}

}  // namespace vantage::fuzz
