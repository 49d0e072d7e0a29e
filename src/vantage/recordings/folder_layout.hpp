#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/recordings/frame_source.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage {

/// One depth image of a folder.
struct LayoutFrame {
  std::string name;
  std::filesystem::path depth;
  std::optional<double> time_s = std::nullopt;
  std::optional<Pose> world_from_sensor = std::nullopt;  // in --unit; none: left out
  std::optional<Intrinsics> intrinsics = std::nullopt;   // of this frame alone
};

/// A folder of depth images as a data set or program lays it out.
struct FolderLayout {
  std::string kind;   // "TUM RGB-D"
  std::string poses;  // "trajectory groundtruth.txt, 598 matched within 20 ms"
  std::vector<LayoutFrame> frames;
  std::optional<Intrinsics> intrinsics;   // of all frames
  std::optional<double> metres_per_unit;  // where the layout says so
  std::vector<std::string> left_out;
};

/// The layout of a folder: by the pattern `depth` of the options, or one of those of TUM RGB-D, ICL-NUIM, BOP, NeRF
/// (transforms.json), COLMAP, ScanNet, Open3D and Redwood, KITTI, and depth images that are numbered in any other way
/// beside poses that are. Nothing where the folder looks like none; throws InputError naming the file that is wrong or
/// missing where it does.
[[nodiscard]] std::optional<FolderLayout> recognise_layout(const std::filesystem::path& folder,
                                                           const ScanFolderOptions& options);

/// The frames of a layout, with the intrinsics of the options where they give some. Throws InputError where there are
/// none.
[[nodiscard]] ScanSet scans_of_layout(const std::filesystem::path& folder, FolderLayout layout,
                                      const ScanFolderOptions& options);

}  // namespace vantage
