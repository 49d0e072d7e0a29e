#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/formats/camera_file.hpp"

namespace vantage {

/// A line of COLMAP's cameras.txt. Its pixel centres lie at halves; here they lie at whole numbers as everywhere.
struct ColmapCamera {
  std::int64_t id = 0;
  Intrinsics intrinsics;
};

/// A pair of lines of COLMAP's images.txt.
struct ColmapImage {
  std::int64_t camera = 0;
  std::string name;
  Pose world_from_sensor = Pose::Identity();
};

/// Whether the text is a cameras.txt: its first line that is no comment has a number and the name of a camera model.
[[nodiscard]] bool is_colmap_cameras(std::string_view bytes);
/// Throws InputError with `name` and the line where a line is not understood or a model is not known.
[[nodiscard]] std::vector<ColmapCamera> parse_colmap_cameras(std::string_view bytes, const std::string& name);
[[nodiscard]] std::vector<ColmapImage> parse_colmap_images(std::string_view bytes, const std::string& name);

}  // namespace vantage
