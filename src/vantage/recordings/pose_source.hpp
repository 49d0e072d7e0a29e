#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/geometry.hpp"
#include "vantage/recordings/pose_match.hpp"

namespace vantage {

/// What is given instead of a folder or a trajectory where poses are not known.
inline constexpr std::string_view without_poses = "none";

/// The poses of scans that lie in `folder`: from `NAME.pose.txt` or `NAME.pose.json` beside them or in the folder
/// `poses`, or from the file of many poses `poses`. `poses` may be relative to `folder`. Scans without a pose, or whose
/// pose is not finite, have none; throws InputError where all have none, saying where one could be.
[[nodiscard]] MatchedPoses poses_of_scans(const std::filesystem::path& folder, const std::string& poses,
                                          const std::vector<FrameKey>& frames, PoseMatch match);

/// The path below `folder` where it exists, else as given.
[[nodiscard]] std::filesystem::path below(const std::filesystem::path& folder, const std::string& path);

/// True where `NAME.pose.txt` or `NAME.pose.json` lies in the folder.
[[nodiscard]] bool has_pose_file(const std::filesystem::path& folder, const std::string& name);

}  // namespace vantage
