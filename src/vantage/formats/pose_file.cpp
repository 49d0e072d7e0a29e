#include "vantage/formats/pose_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/json_text.hpp"
#include "vantage/files/text_reader.hpp"

namespace vantage {
namespace {

/// The first of the keys that the object has.
const nlohmann::json& member(const nlohmann::json& object, std::initializer_list<const char*> keys,
                             const std::string& name) {
  for (const char* key : keys) {
    if (object.contains(key)) return object[key];
  }
  throw InputError(fmt::format("{}: has no '{}'", name, *keys.begin()));
}

/// The numbers of a list, or of an object by its keys.
template <std::size_t Count>
std::array<double, Count> numbers(const nlohmann::json& value, const std::array<const char*, Count>& keys,
                                  const std::string& what) {
  std::array<double, Count> result{};
  require(value.is_object() || (value.is_array() && value.size() == Count), what, ": must be a list of ", Count,
          " numbers or an object with them");
  for (std::size_t i = 0; i < Count; ++i) {
    require(value.is_array() || value.contains(keys[i]), what, ": has no '", keys[i], "'");
    result[i] = json_number(value.is_array() ? value[i] : value[keys[i]], fmt::format("{}.{}", what, keys[i]));
  }
  return result;
}

Eigen::Matrix4d matrix_of(const nlohmann::json& rows, const std::string& what) {
  require(rows.is_array() && rows.size() == 4, what, ": must be a list of 4 rows");
  Eigen::Matrix4d matrix;
  for (std::size_t row = 0; row < 4; ++row) {
    require(rows[row].is_array() && rows[row].size() == 4, what, ": row ", row, " must be a list of 4 numbers");
    for (std::size_t column = 0; column < 4; ++column) {
      matrix(static_cast<int>(row), static_cast<int>(column)) =
          json_number(rows[row][column], fmt::format("{}: row {}, column {}", what, row, column));
    }
  }
  return matrix;
}

Eigen::Matrix4d matrix_of_text(std::string_view bytes, const std::string& name) {
  TextReader text(bytes, name);
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    if (!text.next_line_with_words())
      throw InputError(fmt::format("{}: has {} rows, must be 4 rows of 4 numbers", name, row));
    for (int column = 0; column < 4; ++column) {
      matrix(row, column) = text.number(fmt::format("number {} of row {}", column + 1, row + 1));
    }
    if (!text.at_end_of_line())
      text.fail(fmt::format("{} is a fifth number, must be 4 per row", in_quotes(text.word())));
  }
  if (text.next_line_with_words()) text.fail("a fifth row, must be 4 rows of 4 numbers");
  return matrix;
}

}  // namespace

Pose pose_from_quaternion(const Vec3& translation, const Eigen::Quaterniond& rotation, const std::string& what) {
  require(translation.allFinite() && rotation.coeffs().allFinite(), what, ": has a number that is not finite");
  const double length = rotation.norm();
  require(std::abs(length - 1) < 0.01, what, ": the quaternion has length ", length, ", must be 1");
  Pose pose = Pose::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

Pose parse_pose_text(std::string_view bytes, const std::string& name) {
  return rigid_pose(matrix_of_text(bytes, name), name);
}

Pose parse_pose_json(std::string_view bytes, const std::string& name) {
  const nlohmann::json object = parse_json(bytes, name);
  require(object.is_object(), name, ": must be a JSON object with 'position' and 'orientation', or with 'matrix'");
  if (object.contains("matrix")) return rigid_pose(matrix_of(object["matrix"], name + ": matrix"), name);
  const auto [x, y, z] =
      numbers<3>(member(object, {"position", "translation"}, name), {"x", "y", "z"}, name + ": position");
  const auto [qx, qy, qz, qw] = numbers<4>(member(object, {"orientation", "rotation", "quaternion"}, name),
                                           {"x", "y", "z", "w"}, name + ": orientation");
  return pose_from_quaternion({x, y, z}, Eigen::Quaterniond(qw, qx, qy, qz), name);
}

Pose read_pose(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  return path.extension() == ".json" ? parse_pose_json(bytes, path.string()) : parse_pose_text(bytes, path.string());
}

std::optional<Pose> read_pose_unless_lost(const std::filesystem::path& path) {
  if (path.extension() == ".json") return read_pose(path);
  const Eigen::Matrix4d matrix = matrix_of_text(read_file(path), path.string());
  return matrix.allFinite() ? std::optional(rigid_pose(matrix, path.string())) : std::nullopt;
}

void write_pose(const std::filesystem::path& path, const Pose& pose) {
  std::string text;
  const Eigen::Matrix4d& matrix = pose.matrix();
  for (int row = 0; row < 4; ++row) {
    text += fmt::format("{} {} {} {}\n", matrix(row, 0), matrix(row, 1), matrix(row, 2), matrix(row, 3));
  }
  write_file_atomically(path, text);
}

std::vector<StampedPose> parse_trajectory(std::string_view bytes, const std::string& name) {
  constexpr std::array<const char*, 8> columns{"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  TextReader text(bytes, name);
  std::vector<StampedPose> trajectory;
  while (text.next_line_with_words()) {
    if (trimmed(text.rest_of_line())[0] == '#') continue;
    std::array<double, 8> n{};
    for (std::size_t i = 0; i < n.size(); ++i) n[i] = text.finite_number(columns[i]);
    if (!text.at_end_of_line())
      text.fail(fmt::format("{} is a ninth number, must be 8 per line", in_quotes(text.word())));
    if (!trajectory.empty() && n[0] <= trajectory.back().time) {
      text.fail(fmt::format("timestamp {}: must be later than {} of the line before", n[0], trajectory.back().time));
    }
    trajectory.push_back({n[0], pose_from_quaternion({n[1], n[2], n[3]}, Eigen::Quaterniond(n[7], n[4], n[5], n[6]),
                                                     fmt::format("{}: pose {}", name, trajectory.size()))});
  }
  require(!trajectory.empty(), name, ": has no pose; must have lines 'timestamp tx ty tz qx qy qz qw'");
  return trajectory;
}

std::vector<StampedPose> read_trajectory(const std::filesystem::path& path) {
  return parse_trajectory(read_file(path), path.string());
}

void write_trajectory(const std::filesystem::path& path, const std::vector<StampedPose>& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& stamped : trajectory) {
    const Vec3 t = stamped.pose.translation();
    const Eigen::Quaterniond q(stamped.pose.linear());
    text += fmt::format("{} {} {} {} {} {} {} {}\n", stamped.time, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  }
  write_file_atomically(path, text);
}

}  // namespace vantage
