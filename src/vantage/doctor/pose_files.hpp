#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/doctor/finding.hpp"

namespace vantage {

/// A 4x4 matrix as a file has it, rigid or not.
struct RawPose {
  std::filesystem::path file;
  Eigen::Matrix4d matrix;
};

/// 16 numbers with blanks or commas between, row by row; NaN for words that are none. Nothing for more or fewer.
[[nodiscard]] std::optional<Eigen::Matrix4d> parse_raw_pose(std::string_view bytes);

/// The matrices of all `*.pose.txt` in a folder, by name. Files without 16 numbers are left to the reader of poses,
/// which says what is wrong with them.
[[nodiscard]] std::vector<RawPose> raw_poses(const std::filesystem::path& folder);

/// What is wrong with the matrices themselves: scaled, mirrored, transposed, no rotation at all, not numbers.
[[nodiscard]] std::vector<Finding> check_rotations(const std::vector<RawPose>& poses);

/// One way to make a rigid motion of each matrix: unscaled, transposed back, and, where mirrored, with camera axis
/// `flipped` (0 to 2) or, for 3, with the world's z turned round. Nothing where a matrix is no rotation at all.
[[nodiscard]] std::optional<std::vector<RawPose>> fixed(const std::vector<RawPose>& poses, int flipped);

}  // namespace vantage
