#include <fmt/format.h>
#include <stdlib.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/compression.hpp"
#include "vantage/files/input_file.hpp"
#include "vantage/files/natural_order.hpp"
#include "vantage/files/temporary_folder.hpp"
#include "vantage/files/yaml_text.hpp"
#include "vantage/recordings/bag.hpp"
#include "vantage/recordings/mcap_bag.hpp"
#include "vantage/recordings/ros1_bag.hpp"
#include "vantage/recordings/sqlite_bag.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 4> bag_endings{".mcap", ".db3", ".bag", ".active"};

bool is_packed(const fs::path& path) { return path.extension() == ".zstd" || path.extension() == ".zst"; }

bool has_bag_ending(const fs::path& path) {
  const std::string ending = (is_packed(path) ? path.stem() : path).extension().string();
  return std::find(bag_endings.begin(), bag_endings.end(), ending) != bag_endings.end();
}

/// The files of a recording that was split into several, in the order of their numbers.
std::vector<fs::path> bag_files(const fs::path& folder) {
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && has_bag_ending(entry.path()) && entry.path().filename().string()[0] != '.')
      all.push_back(entry.path());
  }
  std::sort(all.begin(), all.end(), [](const fs::path& a, const fs::path& b) {
    return comes_before(a.filename().string(), b.filename().string());
  });
  std::vector<fs::path> files;
  for (const fs::path& file : all) {
    // ROS leaves the unpacked file beside the packed one after playing it.
    const fs::path unpacked = file.parent_path() / file.stem();
    if (!is_packed(file) || std::find(all.begin(), all.end(), unpacked) == all.end()) files.push_back(file);
  }
  return files;
}

/// Files that metadata.yaml names and that are not in the folder.
std::vector<std::string> missing_files(const fs::path& folder) {
  std::vector<std::string> missing;
  const fs::path metadata = folder / "metadata.yaml";
  if (!fs::exists(metadata)) return missing;
  const YAML::Node root = parse_yaml(read_file(metadata), metadata.string());
  const YAML::Node about = root.IsMap() ? root["rosbag2_bagfile_information"] : YAML::Node();
  const YAML::Node files = about.IsDefined() && about.IsMap() ? about["relative_file_paths"] : YAML::Node();
  if (!files.IsDefined() || !files.IsSequence()) return missing;
  for (const YAML::Node& file : files) {
    const fs::path path = file.IsScalar() ? fs::path(file.Scalar()).filename() : fs::path();
    const bool is_there = fs::exists(folder / path) || fs::exists(folder / (path.string() + ".zstd"));
    if (!is_there) missing.push_back(fmt::format("{}: names {}, which is not there", metadata.string(), path.string()));
  }
  return missing;
}

std::unique_ptr<Bag> open_bag_file(const fs::path& path) {
  const std::string head = InputFile(path).read(0, 16);
  if (McapBag::is_begin_of(head)) return std::make_unique<McapBag>(path);
  if (SqliteBag::is_begin_of(head)) return std::make_unique<SqliteBag>(path);
  if (Ros1Bag::is_begin_of(head)) return std::make_unique<Ros1Bag>(path);
  throw InputError(path.string() + ": is no recording; must be MCAP, sqlite3 (.db3) or a ROS 1 bag, also within .zstd");
}

/// Several files as one bag; packed ones are unpacked into a temporary folder first.
class BagOfFiles : public Bag {
 public:
  BagOfFiles(const std::vector<fs::path>& paths, const std::vector<std::string>& missing) {
    for (const std::string& line : missing) note_damage(line);
    std::string first_trouble;
    for (const fs::path& path : paths) {
      try {
        bags_.push_back(open_bag_file(is_packed(path) ? unpacked(path) : path));
      } catch (const InputError& error) {
        note_damage(error.what());
        if (first_trouble.empty()) first_trouble = error.what();
      }
    }
    if (bags_.empty()) throw InputError(first_trouble);
  }

  void walk(const Visit& visit) override {
    for (std::size_t i = 0; i < bags_.size(); ++i) {
      Bag& bag = *bags_[i];
      bag.walk([&](const BagMessage& message) {
        const BagTopic& topic = bag.topics()[message.topic];
        BagMessage here = message;
        here.topic = topic_index(topic.name, topic.type, topic.encoding);
        here.place.file = static_cast<std::uint32_t>(i);
        visit(here);
      });
      for (const BagTopic& topic : bag.topics()) topic_index(topic.name, topic.type, topic.encoding);
      for (const std::string& line : bag.damage()) note_damage(line);
    }
  }
  std::string read(const MessagePlace& place) override { return bags_.at(place.file)->read(place); }
  std::string format() const override {
    std::string format = bags_.front()->format();
    if (packed_ != nullptr) format += ", packed with zstd";
    return bags_.size() == 1 ? format : fmt::format("{}, {} files", format, bags_.size());
  }

 private:
  fs::path unpacked(const fs::path& path) {
    if (packed_ == nullptr) packed_ = std::make_unique<TemporaryFolder>();
    // Half of the disk is left to others.
    const std::uint64_t limit = fs::space(packed_->path()).available / 2;
    fs::path target = packed_->path() / fmt::format("{}-{}", bags_.size(), path.stem().string());
    const std::string trouble = unpack_zstd_file(path, target, limit);
    if (!trouble.empty()) note_damage(path.string() + ": " + trouble);
    return target;
  }

  std::unique_ptr<TemporaryFolder> packed_;  // outlives the bags in it
  std::vector<std::unique_ptr<Bag>> bags_;
};

}  // namespace

bool is_bag(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return has_bag_ending(path);
  return !bag_files(path).empty();
}

std::unique_ptr<Bag> open_bag(const fs::path& path) {
  require(fs::exists(path), path.string(), ": there is no such file or folder");
  if (!fs::is_directory(path)) {
    if (!is_packed(path)) return open_bag_file(path);
    return std::make_unique<BagOfFiles>(std::vector<fs::path>{path}, std::vector<std::string>());
  }
  const std::vector<fs::path> files = bag_files(path);
  require(!files.empty(), path.string(),
          ": has no recording; must have .mcap, .db3 or .bag files, also with .zstd behind");
  return std::make_unique<BagOfFiles>(files, missing_files(path));
}

}  // namespace vantage
