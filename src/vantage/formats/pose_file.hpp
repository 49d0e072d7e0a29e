#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// The rigid motion of a translation (metres) and a quaternion that may be off unit length by rounding. Throws
/// InputError starting with `what` where a number is not finite or the length is off 1 by more than 1 %.
[[nodiscard]] Pose pose_from_quaternion(const Vec3& translation, const Eigen::Quaterniond& rotation,
                                        const std::string& what);

/// A pose (camera to world) from a file: 4x4 numbers as text, row by row; or, where the name ends in .json, an object
/// with `position` and `orientation` (or `translation` and `rotation`), each as a list (x, y, z and x, y, z, w) or an
/// object with these keys, or with `matrix` as four rows. Throws InputError naming the file and what is wrong: no
/// number, too few or too many, not a rigid motion, mirrored, NaN.
[[nodiscard]] Pose read_pose(const std::filesystem::path& path);
/// The same, but nothing for a matrix with a number that is not finite, as datasets write where tracking was lost.
[[nodiscard]] std::optional<Pose> read_pose_unless_lost(const std::filesystem::path& path);
/// The same from memory; `name` is used in errors.
[[nodiscard]] Pose parse_pose_text(std::string_view bytes, const std::string& name);
[[nodiscard]] Pose parse_pose_json(std::string_view bytes, const std::string& name);

/// Writes 4x4 numbers as text that read_pose() gives back to the last bit; replaces the file atomically.
void write_pose(const std::filesystem::path& path, const Pose& pose);

struct StampedPose {
  double time = 0;  // seconds
  Pose pose = Pose::Identity();
};

/// A trajectory as of the TUM benchmark: `timestamp tx ty tz qx qy qz qw` per line, # for comments. Throws InputError
/// naming the line, also where the times do not increase or there is no pose.
[[nodiscard]] std::vector<StampedPose> read_trajectory(const std::filesystem::path& path);
[[nodiscard]] std::vector<StampedPose> parse_trajectory(std::string_view bytes, const std::string& name);
void write_trajectory(const std::filesystem::path& path, const std::vector<StampedPose>& trajectory);

}  // namespace vantage
