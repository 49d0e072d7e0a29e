#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// One pose of a file of many.
struct ListedPose {
  std::optional<double> time;             // seconds
  std::optional<std::int64_t> number;     // of the frame
  std::optional<Pose> world_from_sensor;  // none where the file says that it was lost (infinite or not a number)
};

/// A file of many poses.
struct PoseList {
  std::string kind;  // "TUM trajectory"
  std::vector<ListedPose> poses;
};

/// The poses of a file, which is recognised by what is in it:
/// - `timestamp tx ty tz qx qy qz qw` per line (TUM; # for comments), also where times repeat or go back;
/// - 12 numbers per line, the upper three rows of a matrix (KITTI), or 16, all four;
/// - blocks of 3 or 4 rows of 4 numbers (ICL-NUIM, many others), also after lines of whole numbers that number the
///   frames (.log of Open3D and Redwood);
/// - JSON of Open3D: a camera trajectory or a pose graph.
/// Throws InputError naming the file, the line and what would be right.
[[nodiscard]] PoseList read_pose_list(const std::filesystem::path& path);
/// The same from memory; `name` is what errors call the file.
[[nodiscard]] PoseList parse_pose_list(std::string_view bytes, const std::string& name);

}  // namespace vantage
