#include "vantage/doctor/readable_poses.hpp"

#include "vantage/core/error.hpp"
#include "vantage/core/geometry.hpp"
#include "vantage/formats/pose_file.hpp"
#include "vantage/recordings/pose_source.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

bool is_mirrored(const std::vector<RawPose>& poses) {
  for (const RawPose& pose : poses) {
    if (pose.matrix.topLeftCorner<3, 3>().determinant() < 0) return true;
  }
  return false;
}

}  // namespace

ReadablePoses::ReadablePoses(const fs::path& scans, const ScanFolderOptions& options) {
  const fs::path folder = options.poses.empty() ? scans : below(scans, options.poses);
  if (!fs::is_directory(folder)) return;
  const std::vector<RawPose> poses = raw_poses(folder);
  findings_ = check_rotations(poses);
  if (findings_.empty()) return;
  const int wanted = is_mirrored(poses) ? 4 : 1;
  ways_ = 0;
  for (int way = 0; way < wanted; ++way) {
    const auto fixed_poses = fixed(poses, way);
    if (!fixed_poses) return;
    if (!copies_) copies_.emplace();
    const fs::path copies = copies_->path() / std::to_string(way);
    fs::create_directory(copies);
    for (const RawPose& pose : *fixed_poses) {
      write_pose(copies / pose.file.filename(), rigid_pose(pose.matrix, pose.file.string(), 0.05));
    }
    ++ways_;
  }
}

ScanFolderOptions ReadablePoses::options(ScanFolderOptions options, int way) const {
  if (copies_) options.poses = (copies_->path() / std::to_string(way)).string();
  return options;
}

std::string ReadablePoses::fix(int way) {
  if (way == 3)
    return "the frames agree: the world is mirrored; negate the z row of every matrix (or x, or y, but one)";
  return concat("negate the ",
                way == 0   ? "first"
                : way == 1 ? "second"
                           : "third",
                " column of every matrix: the camera's ", "xyz"[way], " axis points the wrong way");
}

}  // namespace vantage
