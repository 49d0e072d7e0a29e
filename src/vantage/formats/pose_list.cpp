#include "vantage/formats/pose_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/json_text.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/pose_file.hpp"

namespace vantage {
namespace {

using Numbers = std::vector<double>;

constexpr std::size_t most_per_line = 16;

/// The pose in the rows of a matrix, nothing where a number is not finite.
std::optional<Pose> pose_of_rows(const Numbers& numbers, const std::string& name) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); })) return std::nullopt;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < numbers.size(); ++i)
    matrix(static_cast<int>(i / 4), static_cast<int>(i % 4)) = numbers[i];
  return rigid_pose(matrix, name);
}

/// `timestamp tx ty tz qx qy qz qw`.
ListedPose stamped_pose(const Numbers& n, const std::string& name) {
  require(std::isfinite(n[0]), name, ": timestamp = ", n[0], ": must be a finite number");
  ListedPose listed{.time = n[0], .number = std::nullopt, .world_from_sensor = std::nullopt};
  if (std::all_of(n.begin(), n.end(), [](double each) { return std::isfinite(each); }))
    listed.world_from_sensor = pose_from_quaternion({n[1], n[2], n[3]}, {n[7], n[4], n[5], n[6]}, name);
  return listed;
}

bool is_comment(const TextReader& text) {
  const std::string_view line = trimmed(text.rest_of_line());
  return line[0] == '#' || line[0] == '%';
}

bool is_whole(double number) { return number == std::floor(number) && std::abs(number) < 1e15; }

/// Reads line by line, each with a whole pose, or rows of one.
class PoseLines {
 public:
  PoseLines(std::string_view bytes, const std::string& name) : text_(bytes, name), name_(name) {}

  PoseList read() {
    while (text_.next_line_with_words()) {
      if (is_comment(text_)) continue;
      const Numbers numbers = numbers_of_line();
      if (numbers.size() == 4) {
        add_row(numbers);
      } else {
        finish_block();
        add_line(numbers);
      }
    }
    finish_block();
    require(!list_.poses.empty(), name_, ": has no pose");
    return std::move(list_);
  }

 private:
  /// The numbers of the current line; commas may separate them, as in exported tables.
  Numbers numbers_of_line() {
    line_ = text_.rest_of_line();
    std::replace(line_.begin(), line_.end(), ',', ' ');
    text_.set_rest_of_line(line_);
    Numbers numbers;
    while (!text_.at_end_of_line()) {
      if (numbers.size() == most_per_line) text_.fail(fmt::format("has more than {} numbers", most_per_line));
      numbers.push_back(text_.number(fmt::format("number {}", numbers.size() + 1)));
    }
    return numbers;
  }

  [[nodiscard]] std::string pose_name() const { return fmt::format("{}: pose {}", name_, list_.poses.size()); }

  void become(const char* kind) {
    if (list_.kind.empty()) list_.kind = kind;
    if (list_.kind != kind) text_.fail(fmt::format("a line of a {}, those before are of a {}", kind, list_.kind));
  }

  void add_line(const Numbers& numbers) {
    if (numbers.size() == 8) {
      become("TUM trajectory");
      list_.poses.push_back(stamped_pose(numbers, pose_name()));
    } else if (numbers.size() == 12 || numbers.size() == 16) {
      become(numbers.size() == 12 ? "KITTI trajectory" : "list of 4x4 matrices");
      list_.poses.push_back({std::nullopt, std::nullopt, pose_of_rows(numbers, pose_name())});
    } else if (!numbers.empty() && numbers.size() <= 3 && std::all_of(numbers.begin(), numbers.end(), is_whole)) {
      number_ = static_cast<std::int64_t>(numbers.front());
    } else {
      text_.fail(
          fmt::format("has {} numbers: must be 8 (timestamp tx ty tz qx qy qz qw), 12 or 16 (rows of a matrix), "
                      "or 4 in each of 3 or 4 lines",
                      numbers.size()));
    }
  }

  void add_row(const Numbers& row) {
    // The fourth row tells a matrix of four from the next of three.
    if (rows_.size() == 12 && !is_last_row(row)) finish_block();
    rows_.insert(rows_.end(), row.begin(), row.end());
    if (rows_.size() == 16) finish_block();
  }

  [[nodiscard]] bool is_last_row(const Numbers& row) const {
    const bool is_lost = !std::isfinite(rows_[0]);
    return is_lost || (row[0] == 0 && row[1] == 0 && row[2] == 0 && row[3] == 1);
  }

  void finish_block() {
    if (rows_.empty()) return;
    if (rows_.size() < 12) text_.fail(fmt::format("a matrix of {} rows ends here: must have 3 or 4", rows_.size() / 4));
    become(number_ || list_.kind == "Open3D log" ? "Open3D log" : "list of matrices");
    list_.poses.push_back({std::nullopt, number_, pose_of_rows(rows_, pose_name())});
    number_.reset();
    rows_.clear();
  }

  TextReader text_;
  std::string line_;
  std::string name_;
  PoseList list_;
  Numbers rows_;
  std::optional<std::int64_t> number_;  // of the frame whose matrix comes next
};

/// A 4x4 matrix as Open3D writes it, column by column.
std::optional<Pose> pose_of_columns(const nlohmann::json& list, const std::string& what) {
  require(list.is_array() && list.size() == 16, what, ": must be a list of 16 numbers");
  Numbers rows(16);
  for (std::size_t i = 0; i < 16; ++i) rows[4 * (i % 4) + i / 4] = json_number(list[i], what);
  return pose_of_rows(rows, what);
}

PoseList parse_open3d(std::string_view bytes, const std::string& name) {
  const nlohmann::json object = parse_json(bytes, name);
  PoseList list;
  const auto each_of = [&](const char* key, const auto& pose) {
    require(object[key].is_array() && !object[key].empty(), name, ": '", key, "' must be a list that is not empty");
    for (const nlohmann::json& item : object[key])
      list.poses.push_back(
          {std::nullopt, std::nullopt, pose(item, fmt::format("{}: {} {}", name, key, list.poses.size()))});
  };
  if (object.is_object() && object.contains("parameters")) {
    list.kind = "Open3D camera trajectory";
    each_of("parameters", [](const nlohmann::json& item, const std::string& what) {
      require(item.is_object() && item.contains("extrinsic"), what, ": has no 'extrinsic'");
      const std::optional<Pose> sensor_from_world = pose_of_columns(item["extrinsic"], what + ": extrinsic");
      return sensor_from_world ? std::optional(sensor_from_world->inverse()) : std::nullopt;
    });
  } else {
    require(object.is_object() && object.contains("nodes"), name,
            ": is no list of poses; must be an Open3D camera trajectory ('parameters') or pose graph ('nodes')");
    list.kind = "Open3D pose graph";
    each_of("nodes", [](const nlohmann::json& item, const std::string& what) {
      require(item.is_object() && item.contains("pose"), what, ": has no 'pose'");
      return pose_of_columns(item["pose"], what + ": pose");
    });
  }
  return list;
}

}  // namespace

PoseList parse_pose_list(std::string_view bytes, const std::string& name) {
  const std::string_view begin = trimmed(without_byte_order_mark(bytes));
  if (!begin.empty() && begin[0] == '{') return parse_open3d(bytes, name);
  return PoseLines(bytes, name).read();
}

PoseList read_pose_list(const std::filesystem::path& path) { return parse_pose_list(read_file(path), path.string()); }

}  // namespace vantage
