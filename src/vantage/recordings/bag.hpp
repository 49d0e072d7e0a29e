#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// A stream of messages of one type in a bag.
struct BagTopic {
  std::string name;      // /camera/depth/image_rect_raw
  std::string type;      // sensor_msgs/Image, as ROS 1 writes it
  std::string encoding;  // how its messages are serialised: cdr, ros1, or what Vantage does not read

  bool operator==(const BagTopic&) const = default;
};

/// Where a message is stored, for Bag::read().
struct MessagePlace {
  std::uint32_t file = 0;       // of a bag of several files
  std::uint64_t container = 0;  // chunk, by its byte in the file, or row of the table
  std::uint64_t offset = 0;     // byte within the chunk
  std::uint64_t size = 0;
};

struct BagMessage {
  std::size_t topic = 0;     // index into topics()
  std::int64_t time_ns = 0;  // when it was recorded
  MessagePlace place;
  std::string_view bytes;  // valid during the visit
};

/// A recording of messages on disk: MCAP, the sqlite3 files of ROS 2, or a bag of ROS 1. Bytes of damaged or cut-off
/// files are read as far as that can be done.
class Bag {
 public:
  using Visit = std::function<void(const BagMessage&)>;

  Bag() = default;
  virtual ~Bag() = default;
  Bag(const Bag&) = delete;
  Bag& operator=(const Bag&) = delete;

  /// Calls `visit` with every message that can be read, in the order of the file; memory holds one chunk of it. To be
  /// called once, before the others.
  virtual void walk(const Visit& visit) = 0;
  /// The bytes of a message that was visited.
  [[nodiscard]] virtual std::string read(const MessagePlace& place) = 0;
  /// The format, with its compression: "MCAP (zstd)".
  [[nodiscard]] virtual std::string format() const = 0;

  /// In the order in which they were met.
  [[nodiscard]] const std::vector<BagTopic>& topics() const { return topics_; }
  /// What could not be read, a line each, naming the file and the place.
  [[nodiscard]] const std::vector<std::string>& damage() const { return damage_; }

 protected:
  /// The place of this topic among topics(), where it is added if it is new. "pkg/msg/Type" becomes "pkg/Type".
  std::size_t topic_index(const std::string& name, std::string type, const std::string& encoding);
  /// Notes what could not be read; of many such places the first ten.
  void note_damage(const std::string& line);

 private:
  std::vector<BagTopic> topics_;
  std::vector<std::string> damage_;
};

/// Whether the path looks like a bag: a file .mcap, .db3 or .bag (also with .zstd behind it), or a folder with such
/// files.
[[nodiscard]] bool is_bag(const std::filesystem::path& path);

/// Opens a bag by its first bytes, or all the files of a folder as one. Throws InputError naming the path and what is
/// wrong where it is no bag, or nothing of it can be read.
[[nodiscard]] std::unique_ptr<Bag> open_bag(const std::filesystem::path& path);

/// Of the chunks of a bag, the unpacked ones that were used last: frames of depth and colour that belong together
/// often lie in neighbouring chunks.
class ChunkCache {
 public:
  /// The chunk at this place of the file, from `load` where it is not at hand.
  const std::string& chunk(std::uint64_t place, const std::function<std::string()>& load);

 private:
  struct Entry {
    std::uint64_t place = 0;
    std::string bytes;
  };
  std::vector<Entry> entries_;  // last used first
};

/// Largest unpacked chunk, and largest message outside of one. Writers make chunks of some MB, with one message at the
/// least; a cloud of ten million points is within the limit.
inline constexpr std::uint64_t largest_chunk = std::uint64_t{256} << 20;

}  // namespace vantage
