#pragma once

#include <string>
#include <string_view>

#include "vantage/formats/camera_file.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/formats/point_cloud_file.hpp"
#include "vantage/recordings/frame.hpp"
#include "vantage/recordings/ros_messages.hpp"

namespace vantage {

// What messages of ROS hold, as the project's own images and clouds. Each throws InputError starting with `name` where
// the message contradicts itself or is of a kind that is not read.

/// Whether images of this encoding may be depth images: 16UC1 and mono16 (whole numbers) or 32FC1 (metres).
[[nodiscard]] bool is_depth_encoding(std::string_view encoding);
[[nodiscard]] DepthPixels depth_of(const RosImage& image, const std::string& name);
/// A colour or grey image: rgb8, bgr8, rgba8, bgra8, mono8 and their synonyms.
[[nodiscard]] bool is_color_encoding(std::string_view encoding);
[[nodiscard]] ColorImage color_of(const RosImage& image, const std::string& name);

/// Depth as compressed_depth_image_transport writes it: a PNG of 16 bits or RVL; numbers of 32FC1 are inverse depths.
[[nodiscard]] DepthPixels depth_of(const RosCompressedImage& image, const std::string& name);

/// Points in the frame of the message: x, y, z and, where there are, normals. Organised where it has rows.
[[nodiscard]] CloudFile cloud_of(const RosPointCloud& cloud, const std::string& name);

/// Intrinsics of images of this topic. The name says which: `rect` in it means that images are rectified, and then the
/// projection matrix P counts, else K with the distortion.
[[nodiscard]] Intrinsics intrinsics_of(const RosCameraInfo& info, bool is_rectified, const std::string& name);

/// Unpacks RVL (A. D. Wilson, "Fast lossless depth image compression", 2017): runs of zeros, and differences to the
/// pixel before in groups of three bits.
[[nodiscard]] std::vector<std::uint16_t> unpack_rvl(std::string_view bytes, std::size_t pixels,
                                                    const std::string& name);

}  // namespace vantage
