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

constexpr double longest_gap = 0.02;  // seconds between a frame and its pose; robots report at 50 Hz or more

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

Pose pose_from_folder(const std::filesystem::path& scans, const std::filesystem::path& folder,
                      const std::string& name) {
  if (const auto path = pose_file(folder, name)) return read_pose(*path);
  const std::string elsewhere = folders_with_pose(scans, name);
  throw InputError(fmt::format("{}: scan {} has no pose; must have {}.pose.txt or {}.pose.json{}", folder.string(),
                               in_quotes(name), name, name,
                               elsewhere.empty() ? "" : "; choose one of the folders with --poses: " + elsewhere));
}

Pose pose_at(const std::vector<StampedPose>& trajectory, double time, const std::string& what) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), time,
                                      [](const StampedPose& stamped, double t) { return stamped.time < t; });
  const StampedPose* nearest = nullptr;
  if (after != trajectory.end()) nearest = &*after;
  if (after != trajectory.begin() && (nearest == nullptr || time - std::prev(after)->time < nearest->time - time)) {
    nearest = &*std::prev(after);
  }
  if (std::abs(nearest->time - time) > longest_gap) {
    throw InputError(fmt::format("{}: the nearest pose is {:.3f} s away, must be within {} s", what,
                                 std::abs(nearest->time - time), longest_gap));
  }
  return nearest->pose;
}

std::vector<Pose> poses_from_trajectory(const std::filesystem::path& file, const std::vector<std::string>& names) {
  const std::vector<StampedPose> trajectory = read_trajectory(file);
  std::vector<Pose> poses;
  const bool by_time = std::all_of(names.begin(), names.end(), [](const std::string& name) {
    const auto time = to_double(name);
    return time && std::isfinite(*time);
  });
  if (by_time) {
    for (const std::string& name : names) {
      poses.push_back(
          pose_at(trajectory, *to_double(name), fmt::format("{}: scan {}", file.string(), in_quotes(name))));
    }
    return poses;
  }
  require(trajectory.size() == names.size(), file.string(), ": has ", trajectory.size(), " poses for ", names.size(),
          " scans; must be one each, in their order, or the scans must be named by their times");
  for (const StampedPose& stamped : trajectory) poses.push_back(stamped.pose);
  return poses;
}

}  // namespace

std::filesystem::path below(const std::filesystem::path& folder, const std::string& path) {
  std::filesystem::path inside = folder / path;
  return std::filesystem::exists(inside) ? inside : std::filesystem::path(path);
}

bool has_pose_file(const std::filesystem::path& folder, const std::string& name) {
  return pose_file(folder, name).has_value();
}

std::vector<Pose> poses_of_scans(const std::filesystem::path& folder, const std::string& poses,
                                 const std::vector<std::string>& names) {
  const std::filesystem::path source = poses.empty() ? folder : below(folder, poses);
  require(std::filesystem::exists(source), "poses = ", in_quotes(poses), ": there is no such folder or file in ",
          folder.string());
  if (!std::filesystem::is_directory(source)) return poses_from_trajectory(source, names);
  std::vector<Pose> result;
  for (const std::string& name : names) result.push_back(pose_from_folder(folder, source, name));
  return result;
}

}  // namespace vantage
