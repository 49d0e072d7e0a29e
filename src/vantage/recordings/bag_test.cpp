#include "vantage/recordings/bag.hpp"

#include <gmock/gmock.h>

#include <set>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/byte_reader.hpp"
#include "vantage/recordings/bag_frames.hpp"
#include "vantage/recordings/bag_index.hpp"
#include "vantage/recordings/recording_info.hpp"

namespace vantage {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::filesystem::path bags = VANTAGE_BAGS;
constexpr const char* depth_topic = "/camera/depth/image_raw";

std::uint64_t messages_of(const BagIndex& index, const std::string& topic) {
  const TopicIndex* found = index.find(topic);
  return found == nullptr ? 0 : found->messages;
}

/// Everything that can be read of a bag: the frames of all its topics are decoded. How many there were.
int read_all(const std::filesystem::path& path) {
  const std::unique_ptr<Bag> bag = open_bag(path);
  const BagIndex index = index_bag(*bag);
  int frames = 0;
  for (const TopicIndex& topic : index.topics) {
    if (!has_depth(topic)) continue;
    try {
      const auto source = open_bag_frames(path, {.topic = topic.topic.name});
      for (auto frame = source->next(); frame; frame = source->next()) ++frames;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()), "");
    }
  }
  (void)recording_info(path);
  return frames;
}

TEST(Bag, AllMessagesOfOtherPeoplesRecordingsAreCounted) {
  for (const char* file : {"/recordings/all_types.mcap", "/recordings/all_types.db3"}) {
    const std::filesystem::path path = std::string(VANTAGE_SHARED_DATA) + file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    const std::unique_ptr<Bag> bag = open_bag(path);
    const BagIndex index = index_bag(*bag);
    EXPECT_THAT(bag->damage(), IsEmpty());
    EXPECT_EQ(index.topics.size(), 94U) << file;
    for (const TopicIndex& topic : index.topics) {
      EXPECT_EQ(topic.messages, 2U) << topic.topic.name;
      EXPECT_EQ(topic.unreadable, 0U) << topic.first_trouble;
    }
  }
}

TEST(Bag, ABagWithoutAnEndIsReadUpToIt) {
  const std::uint64_t whole = open_bag_frames(bags / "none.mcap", {.topic = depth_topic})->frames().size();
  for (const char* file : {"none.mcap", "lz4.mcap", "zstd.mcap", "flat.mcap", "none.bag", "lz4.bag", "bz2.bag"}) {
    const std::string bytes = read_file(bags / file);
    const TestFolder folder;
    const auto path = folder / file;
    std::set<std::uint64_t> counts;
    for (std::size_t size = bytes.size(); size > 0; size -= std::min<std::size_t>(size, 997)) {
      write_file_atomically(path, bytes.substr(0, size));
      if (size < 16) continue;
      const std::unique_ptr<Bag> bag = open_bag(path);
      const BagIndex index = index_bag(*bag);
      const std::uint64_t count = messages_of(index, depth_topic);
      EXPECT_TRUE(counts.empty() || count <= *counts.begin()) << file << " of " << size << " bytes";
      counts.insert(count);
      if (count < whole) {
        EXPECT_THAT(bag->damage(), Not(IsEmpty())) << file << " of " << size << " bytes";
      }
    }
    EXPECT_GE(counts.size(), 4U) << file << ": frames are lost chunk by chunk";
  }
}

TEST(Bag, WhatFollowsDamageIsRead) {
  for (const char* file : {"none.mcap", "lz4.mcap", "zstd.mcap", "none.bag", "lz4.bag", "bz2.bag", "small.db3"}) {
    std::string bytes = read_file(bags / file);
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 3), 300, '\x55');
    const TestFolder folder;
    const auto path = folder / file;
    write_file_atomically(path, bytes);
    const std::unique_ptr<Bag> bag = open_bag(path);
    const BagIndex index = index_bag(*bag);
    const TopicIndex* depth = index.find(depth_topic);
    ASSERT_NE(depth, nullptr) << file;
    if (std::string(file) == "small.db3") {  // has no checksums, and a damaged page may lead to others
      EXPECT_GE(depth->frames.size(), 1U);
      continue;
    }
    ASSERT_GE(depth->frames.size(), 3U) << file;
    // Pixels that are not packed have no checksum in ROS 1.
    if (std::string(file) != "none.bag") {
      EXPECT_THAT(bag->damage(), Not(IsEmpty())) << file;
    }
    EXPECT_EQ(depth->frames.back().time_ns, 1'700'000'000'500'000'000) << file << ": the last frame is read";
  }
}

/// Where the sizes of the data of a ROS 1 bag's chunks are: each record has a header and data behind their sizes.
std::vector<std::size_t> chunk_sizes(const std::string& bytes) {
  std::vector<std::size_t> places;
  for (std::size_t at = 13; at + 8 < bytes.size();) {
    const std::size_t header = little_endian<4>(bytes.data() + at), size = at + 4 + header;
    if (bytes.substr(at, header + 4).find(std::string_view("op=\x05")) != std::string::npos) places.push_back(size);
    at = size + 4 + little_endian<4>(bytes.data() + size);
  }
  return places;
}

TEST(Ros1Bag, AWrongSizeOfAChunkLosesNoOther) {
  const std::string whole = read_file(bags / "none.bag");
  const std::vector<std::size_t> sizes = chunk_sizes(whole);
  ASSERT_GE(sizes.size(), 4U);
  for (const std::size_t added : {std::size_t{5}, sizes[3] - sizes[1] + 9, std::size_t{100'000}}) {
    std::string bytes = whole;
    const std::size_t size = little_endian<4>(whole.data() + sizes[1]) + added;
    for (std::size_t i = 0; i < 4; ++i) bytes[sizes[1] + i] = static_cast<char>(size >> (8 * i) & 0xff);
    const TestFolder folder;
    write_file_atomically(folder / "a.bag", bytes);
    const auto source = open_bag_frames(folder / "a.bag", {.topic = depth_topic});
    EXPECT_EQ(source->frames().size(), 6U) << added << ": what the chunk holds is read, too";
    EXPECT_THAT(source->left_out(), Contains(HasSubstr("are damaged; what can be read of them is"))) << added;
    for (auto frame = source->next(); frame; frame = source->next()) {
      EXPECT_EQ(std::get<Gray16>(std::get<DepthPixels>(frame->measured)).values.size(), 192U);
    }
  }
}

TEST(Ros1Bag, MessagesBehindADamagedOneOfTheirChunkAreRead) {
  const std::string whole = read_file(bags / "none.bag");
  // The first header of a message in the first chunk that has an image and more: its size becomes nonsense.
  const std::size_t chunk = chunk_sizes(whole).front() + 4;
  std::string bytes = whole;
  const std::size_t message = whole.find(std::string_view("\x04\0\0\0op=\x02", 8), chunk);
  ASSERT_NE(message, std::string::npos);
  for (std::size_t i = message - 40; i < message + 8; ++i) bytes[i] = '\x55';
  const TestFolder folder;
  write_file_atomically(folder / "a.bag", bytes);
  const std::unique_ptr<Bag> bag = open_bag(folder / "a.bag");
  const BagIndex index = index_bag(*bag);
  EXPECT_THAT(bag->damage(), Contains(HasSubstr("bytes of the chunk are passed over")));
  EXPECT_EQ(messages_of(index, depth_topic), 6U) << "the first message is one of /tf_static";
}

TEST(Ros1Bag, ConnectionsAreKnownFromTheIndexWhereTheFirstChunkIsLost) {
  std::string bytes = read_file(bags / "bz2.bag");
  const std::size_t chunk = chunk_sizes(bytes).front() + 4;
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(chunk), 200, '\x55');
  const TestFolder folder;
  write_file_atomically(folder / "a.bag", bytes);
  const std::unique_ptr<Bag> bag = open_bag(folder / "a.bag");
  const BagIndex index = index_bag(*bag);
  EXPECT_GE(messages_of(index, depth_topic), 4U);
  EXPECT_THAT(bag->damage(), Not(IsEmpty()));
}

TEST(Bag, DamagedBytesAreReadOrRefused) {
  for (const char* file : {"lz4.mcap", "zstd.mcap", "flat.mcap", "none.bag", "bz2.bag", "small.db3"}) {
    const TestFolder folder;
    const auto path = folder / file;
    const FuzzCount count = read_damaged(read_file(bags / file), 60, [&](const std::string& bytes) {
      write_file_atomically(path, bytes);
      (void)read_all(path);
    });
    EXPECT_GT(count.accepted, 0) << file;
  }
  EXPECT_GT(read_all(bags / "zstd.mcap"), 20);
}

TEST(Bag, AHugeChunkIsRefusedBeforeMemoryIsTaken) {
  std::string bytes = read_file(bags / "zstd.mcap");
  // The first chunk's record says how large it is unpacked: a byte, its length, two times, then this.
  const std::size_t chunk = bytes.find(std::string("\x06", 1), 8 + 9 + bytes.at(9));
  ASSERT_LT(chunk, 100U);
  bytes.replace(chunk + 9 + 16, 8, std::string("\0\0\0\0\1\0\0\0", 8));
  const TestFolder folder;
  write_file_atomically(folder / "huge.mcap", bytes);
  const std::unique_ptr<Bag> bag = open_bag(folder / "huge.mcap");
  (void)index_bag(*bag);
  EXPECT_THAT(bag->damage(), Contains(HasSubstr("a chunk unpacks to 4294967296 bytes; must be at most 268435456")));
}

TEST(Bag, FilesThatMetadataNamesAndThatAreMissingAreReported) {
  const TestFolder folder;
  std::filesystem::copy(bags / "split", folder.path(),
                        std::filesystem::copy_options::overwrite_existing | std::filesystem::copy_options::recursive);
  std::filesystem::remove(folder / "bag_1.db3");
  const auto source = open_bag_frames(folder.path(), {.topic = depth_topic});
  EXPECT_GE(source->frames().size(), 2U);
  EXPECT_THAT(source->left_out(), Contains(HasSubstr("metadata.yaml: names bag_1.db3, which is not there")));
}

TEST(Bag, OtherFilesAreRefusedByTheirFirstBytes) {
  const TestFolder folder;
  write_file_atomically(folder / "a.mcap", "not a bag at all, but long enough");
  EXPECT_THAT(input_error_of([&] { (void)open_bag(folder / "a.mcap"); }),
              HasSubstr("a.mcap: is no recording; must be"));
  write_file_atomically(folder / "old.bag", "#ROSBAG V1.2\nxxxxxxxxxxxx");
  EXPECT_THAT(input_error_of([&] { (void)open_bag(folder / "old.bag"); }), HasSubstr("must be 2.0"));
  EXPECT_TRUE(is_bag("run.db3.zstd"));
  EXPECT_TRUE(is_bag(bags / "split"));
  EXPECT_FALSE(is_bag(folder / "a.ply"));
}

TEST(RecordingInfo, ListsWhatIsInABag) {
  const RecordingInfo info = recording_info(bags / "lz4.bag");
  EXPECT_EQ(info.format, "ROS 1 bag (lz4)");
  EXPECT_NEAR(info.duration_s, 0.5, 1e-9);
  ASSERT_EQ(info.topics.size(), 4U);
  EXPECT_EQ(info.topics[1].name, depth_topic);
  EXPECT_EQ(info.topics[1].content, "16x12 16UC1");
  EXPECT_EQ(info.topics[1].messages, 6U);
  EXPECT_NEAR(info.topics[1].rate_hz, 10, 1e-9);
  EXPECT_THAT(info.frames, ElementsAre("base", "  hand  6 poses, 10.0 Hz", "    camera_link  static",
                                       "      camera_optical_frame  static"));
  ASSERT_EQ(info.sources.size(), 1U);
  EXPECT_THAT(info.sources[0].options, ElementsAre("--topic", depth_topic, "--frame", "base"));
  EXPECT_EQ(recording_info(bags / "zstd.mcap").sources.size(), 5U);
}

}  // namespace
}  // namespace vantage
