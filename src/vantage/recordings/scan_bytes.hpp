#pragma once

#include <string>
#include <string_view>

#include "vantage/formats/depth_image.hpp"
#include "vantage/formats/point_cloud_file.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage {

/// What the numbers of a depth image mean by the options.
[[nodiscard]] DepthEncoding depth_encoding(const ScanFolderOptions& options);

/// The pose of the sensor where the robot says `read`: in metres, with the hand-eye offset. `hand_eye` is
/// hand_eye_offset().
[[nodiscard]] Pose sensor_pose(const Pose& read, const Pose& hand_eye, const ScanFolderOptions& options);
/// The offset of the options (hand from sensor, metres), the identity where they have none. Throws InputError naming
/// the option or the file.
[[nodiscard]] Pose hand_eye_offset(const ScanFolderOptions& options);

/// A depth image of a camera with these intrinsics, without the pixels that the mask takes away and without distortion.
/// Throws InputError where the sizes do not fit.
[[nodiscard]] Scan scan_of_depth(const DepthPixels& pixels, const Intrinsics& intrinsics,
                                 const std::optional<Mask>& mask, const ScanFolderOptions& options);

/// The same, and what lies outside of the crop box of the options by the believed pose is unknown.
[[nodiscard]] Scan scan_of_depth(const DepthPixels& pixels, const Intrinsics& intrinsics,
                                 const std::optional<Mask>& mask, const View& believed,
                                 const ScanFolderOptions& options);

/// A cloud as points in the sensor's frame, metres, with sight lines from its origin. `world_from_sensor` is the
/// sensor's pose, for clouds whose points are in the world's frame.
[[nodiscard]] Scan scan_of_cloud(const CloudFile& file, const Pose& world_from_sensor,
                                 const ScanFolderOptions& options);

/// The scan without what lies outside the crop box of the options by the believed pose: pixels become unknown, points
/// are left out.
[[nodiscard]] Scan cropped(Scan scan, const View& believed, const ScanFolderOptions& options);

}  // namespace vantage
