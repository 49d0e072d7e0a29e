#pragma once

#include <string_view>

#include "vantage/formats/camera_file.hpp"
#include "vantage/recordings/scan_folder.hpp"
#include "vantage/session/session_scan.hpp"

namespace vantage {

/// What is known of scans before they come.
struct UploadOptions {
  ScanFolderOptions reading;
  Pose hand_eye = Pose::Identity();      // hand from sensor, metres
  std::optional<Intrinsics> intrinsics;  // of scans that bring none
  // What a scan may unpack to: pixels of a depth image, numbers of a cloud.
  std::int64_t most_pixels = std::int64_t{1} << 24;
  std::size_t most_values = std::size_t{1} << 25U;
};

/// Those of a session with these options of reading; a file with intrinsics is read where it exists. Throws InputError
/// naming the option.
[[nodiscard]] UploadOptions upload_options(const ScanFolderOptions& reading);

/// The scan in a `multipart/form-data` body, whose parts are separated by `boundary`, with the fields
/// - `depth`: a depth image as docs/sessions.md says, or `cloud`: a file NAME.ply, .pcd, .xyz or .xyzn;
/// - `mask` (of a depth image, may be missing): a PNG of its size whose black pixels do not count;
/// - `pose`: sensor to world, 4x4 numbers or JSON as in NAME.pose.txt and NAME.pose.json;
/// - `commanded`, likewise: where the sensor was sent, which may be missing;
/// - `intrinsics` (of a depth image; where the options have none): as in camera-intrinsics.txt, .yaml or .json;
/// - `name`, `candidate` and `key` (SessionScan), which may be missing.
/// Throws InputError naming the field and what would be right.
[[nodiscard]] SessionScan parse_scan_upload(std::string_view body, std::string_view boundary,
                                            const UploadOptions& options);

}  // namespace vantage
