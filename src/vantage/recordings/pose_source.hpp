#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// One pose for each of the scans with these names, which lie in `folder`: from `NAME.pose.txt` or `NAME.pose.json`
/// beside them or in the folder `poses`, or from the trajectory file `poses` by time (names that are numbers) or by
/// order. `poses` may be relative to `folder`. Throws InputError naming the scan without a pose and where one could be.
[[nodiscard]] std::vector<Pose> poses_of_scans(const std::filesystem::path& folder, const std::string& poses,
                                               const std::vector<std::string>& names);

/// The path below `folder` where it exists, else as given.
[[nodiscard]] std::filesystem::path below(const std::filesystem::path& folder, const std::string& path);

/// True where `NAME.pose.txt` or `NAME.pose.json` lies in the folder.
[[nodiscard]] bool has_pose_file(const std::filesystem::path& folder, const std::string& name);

}  // namespace vantage
