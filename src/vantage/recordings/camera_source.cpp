#include "vantage/recordings/camera_source.hpp"

#include <fmt/format.h>

#include <array>

#include "vantage/core/error.hpp"
#include "vantage/recordings/pose_source.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::array usual{"camera-intrinsics.txt",
                           "camera-intrinsics.yaml",
                           "camera-intrinsics.json",
                           "camera_info.yaml",
                           "intrinsics.txt",
                           "intrinsics.json",
                           "camera.json",
                           "camera_intrinsic.json",
                           "camera_intrinsics.json",
                           "camera_intrinsics.txt",
                           "intrinsic.json",
                           "intrinsic.txt",
                           "depth_intrinsics.txt",
                           "depth_intrinsics.json",
                           "intrinsic/intrinsic_depth.txt",
                           "calibration.yaml",
                           "calibration.json",
                           "calib.txt",
                           "cam_params.json",
                           "camera.yaml"};

}  // namespace

fs::path intrinsics_file(const fs::path& folder, const std::string& given) {
  if (!given.empty()) return below(folder, given);
  for (const fs::path& place : {folder, folder / ".."}) {
    for (const char* name : usual) {
      if (fs::is_regular_file(place / name)) return (place / name).lexically_normal();
    }
  }
  throw InputError(fmt::format(
      "{}: has no intrinsics; must have one of {} ..., or give a file with --intrinsics (a text file with fx fy "
      "cx cy will do; TUM RGB-D names 525 525 319.5 239.5, 7-Scenes 585 585 320 240)",
      folder.string(), fmt::join(usual.begin(), usual.begin() + 7, ", ")));
}

}  // namespace vantage
