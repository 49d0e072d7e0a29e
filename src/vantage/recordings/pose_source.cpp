#include "vantage/recordings/pose_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/pose_file.hpp"

namespace vantage {
namespace {

std::optional<std::filesystem::path> pose_file(const std::filesystem::path& folder, const std::string& name) {
  for (const char* ending : {".pose.txt", ".pose.json"}) {
    std::filesystem::path path = folder / (name + ending);
    if (std::filesystem::exists(path)) return path;
  }
  return std::nullopt;
}

/// Subfolders that have a pose of this scan, for the error of one that has none.
std::string folders_with_pose(const std::filesystem::path& folder, const std::string& name) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_directory() && has_pose_file(entry.path(), name)) found.push_back(entry.path().filename().string());
  }
  std::sort(found.begin(), found.end());
  return fmt::format("{}", fmt::join(found, ", "));
}

/// Poses of files NAME.pose.txt or .json; scans without one have none, but one must have.
MatchedPoses poses_from_files(const std::filesystem::path& scans, const std::filesystem::path& folder,
                              const std::vector<FrameKey>& frames) {
  MatchedPoses result;
  std::size_t matched = 0;
  for (const FrameKey& frame : frames) {
    const auto path = pose_file(folder, frame.name);
    result.poses.push_back(path ? read_pose_unless_lost(*path) : std::nullopt);
    result.why_not.emplace_back(path ? "has a pose that is not finite: tracking was lost" : "has no pose");
    matched += path ? 1 : 0;
  }
  if (matched == 0) {
    const std::string& name = frames.front().name;
    const std::string elsewhere = folders_with_pose(scans, name);
    throw InputError(fmt::format("{}: scan {} has no pose; must have {}.pose.txt or {}.pose.json{}", folder.string(),
                                 in_quotes(name), as_utf8(name), as_utf8(name),
                                 elsewhere.empty() ? "" : "; choose one of the folders with --poses: " + elsewhere));
  }
  result.how = "a pose file each";
  return result;
}

}  // namespace

std::filesystem::path below(const std::filesystem::path& folder, const std::string& path) {
  std::filesystem::path inside = folder / path;
  return std::filesystem::exists(inside) ? inside : std::filesystem::path(path);
}

bool has_pose_file(const std::filesystem::path& folder, const std::string& name) {
  return pose_file(folder, name).has_value();
}

MatchedPoses poses_of_scans(const std::filesystem::path& folder, const std::string& poses,
                            const std::vector<FrameKey>& frames, PoseMatch match) {
  if (poses == without_poses) {
    return {.poses = std::vector<std::optional<Pose>>(frames.size(), Pose::Identity()),
            .why_not = std::vector<std::string>(frames.size()),
            .how = "no poses"};
  }
  const std::filesystem::path source = poses.empty() ? folder : below(folder, poses);
  require(std::filesystem::exists(source), "poses = ", in_quotes(poses), ": there is no such folder or file in ",
          folder.string());
  MatchedPoses result = std::filesystem::is_directory(source)
                            ? poses_from_files(folder, source, frames)
                            : match_poses(read_pose_list(source), frames, match, source.string());
  const bool has_one =
      std::any_of(result.poses.begin(), result.poses.end(), [](const auto& pose) { return pose.has_value(); });
  require(has_one, source.string(), ": none of the ", frames.size(), " scans has a pose; scan ",
          in_quotes(frames.front().name), " ", result.why_not.front());
  return result;
}

}  // namespace vantage
