#include <fmt/format.h>

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/recordings/layout_parts.hpp"
#include "vantage/recordings/pose_source.hpp"

namespace vantage::layout_parts {
namespace {

const std::vector<std::string>& trajectories() {
  static const std::vector<std::string> names{"groundtruth.txt",
                                              "trajectory.log",
                                              "scene/trajectory.log",
                                              "camera_trajectory.json",
                                              "trajectory.txt",
                                              "trajectory.tum",
                                              "traj.txt",
                                              "poses.txt",
                                              "pose_graph_optimized.json",
                                              "pose_graph.json",
                                              "CameraTrajectory.txt",
                                              "KeyFrameTrajectory.txt",
                                              "*-traj.txt",
                                              "*.log",
                                              "*.gt.freiburg",
                                              "*.gt.sim"};
  return names;
}

/// Where the poses of a folder of depth images are: a file of many, or a folder of files.
std::optional<fs::path> pose_source(const fs::path& folder, const fs::path& depths) {
  for (const char* name : {"pose", "poses"}) {
    if (fs::is_directory(folder / name)) return folder / name;
  }
  if (const auto file = first_file(folder, trajectories())) return file;
  for (const fs::path& each : {depths, folder}) {
    for (const auto& entry : fs::directory_iterator(each)) {
      const std::string stem = entry.path().stem().string();
      if (entry.path().extension() == ".txt" && stem.find("pose") != std::string::npos && number_in(stem)) return each;
    }
  }
  return std::nullopt;
}

/// What has this layout, as far as its files say it.
std::string kind_of(const fs::path& folder, const fs::path& poses) {
  const std::string file = poses.filename().string();
  if (fs::exists(folder / "intrinsic" / "intrinsic_depth.txt")) return "ScanNet";
  if (file == "trajectory.log" || file == "camera_trajectory.json" || file.find("pose_graph") == 0) return "Open3D";
  if (file.find("-traj.txt") != std::string::npos) return "Redwood";
  return "numbered frames";
}

std::vector<fs::path> images_named_depth(const fs::path& folder) {
  std::vector<fs::path> images = depth_images_in(folder);
  std::erase_if(images, [](const fs::path& path) {
    const std::string name = path.filename().string();
    return name.find("depth") == std::string::npos && name.find("Depth") == std::string::npos;
  });
  return images;
}

}  // namespace

std::optional<FolderLayout> numbered(const fs::path& folder, const ScanFolderOptions& options) {
  std::vector<fs::path> images;
  if (!options.depth.empty()) {
    images = files_matching(folder, options.depth);
    require(!images.empty(), "depth = '", options.depth, "': no file in ", folder.string(), " fits it");
    for (const fs::path& image : images)
      require(is_depth_image(image), image.string(),
              ": is no depth image; must be .png, .exr, .tif, .raw, .npy or .pfm");
  }
  for (const char* name : {"depth", "depths", "depth_images", "Depth"}) {
    if (images.empty()) images = depth_images_in(folder / name);
  }
  if (images.empty()) images = images_named_depth(folder);
  if (images.empty()) return std::nullopt;
  FolderLayout layout;
  layout.frames = frames_of(images);
  const auto source = options.poses.empty() ? pose_source(folder, images.front().parent_path())
                                            : std::optional(below(folder, options.poses));
  require(
      source.has_value(), folder.string(), ": has ", images.size(),
      " depth images but no poses; must have a folder pose/ of files, a trajectory (groundtruth.txt, trajectory.log, "
      "camera_trajectory.json, traj.txt, poses.txt), or give one with --poses");
  require(!options.has_poses() || fs::exists(*source), "poses = '", options.poses,
          "': there is no such folder or file in ", folder.string());
  layout.kind = options.has_poses() ? kind_of(folder, *source) : "numbered frames";
  take_poses(layout, *source, options);
  return layout;
}

}  // namespace vantage::layout_parts
