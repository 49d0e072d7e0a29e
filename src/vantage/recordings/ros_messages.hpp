#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/geometry.hpp"
#include "vantage/recordings/message_reader.hpp"

namespace vantage {

// The messages of ROS 1 and ROS 2 that say what a depth sensor saw and from where. Views of bytes point into the
// message that was read. Each read_...() takes the reader at the beginning of its message and throws InputError naming
// it where the message is no such one.

struct RosHeader {
  std::int64_t stamp_ns = 0;  // 0: not set
  std::string frame_id;       // without a slash ahead, as tf2 writes it
};
[[nodiscard]] RosHeader read_header(MessageReader& reader);

/// sensor_msgs/Image
struct RosImage {
  RosHeader header;
  std::uint32_t height = 0, width = 0;
  std::string encoding;  // such as 16UC1
  bool is_big_endian = false;
  std::uint32_t step = 0;  // bytes per row
  std::string_view data;
};
[[nodiscard]] RosImage read_image(MessageReader& reader);

/// sensor_msgs/CompressedImage
struct RosCompressedImage {
  RosHeader header;
  std::string format;  // such as "16UC1; compressedDepth png"
  std::string_view data;
};
[[nodiscard]] RosCompressedImage read_compressed_image(MessageReader& reader);

/// sensor_msgs/CameraInfo
struct RosCameraInfo {
  RosHeader header;
  std::uint32_t height = 0, width = 0;  // of the whole sensor
  std::string distortion_model;
  std::vector<double> distortion;
  std::array<double, 9> k{};                                          // of the image as taken, row by row
  std::array<double, 12> p{};                                         // of the rectified image
  std::uint32_t binning_x = 0, binning_y = 0;                         // 0 means 1
  std::uint32_t roi_x = 0, roi_y = 0, roi_height = 0, roi_width = 0;  // 0x0: all
};
[[nodiscard]] RosCameraInfo read_camera_info(MessageReader& reader);

/// sensor_msgs/PointCloud2
struct RosPointField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t type = 0;  // 1 to 8: int8, uint8, int16, uint16, int32, uint32, float32, float64
};
struct RosPointCloud {
  RosHeader header;
  std::uint32_t height = 0, width = 0;
  std::vector<RosPointField> fields;
  bool is_big_endian = false;
  std::uint32_t point_step = 0, row_step = 0;
  std::string_view data;
};
[[nodiscard]] RosPointCloud read_point_cloud(MessageReader& reader);

/// A pose of `child` in the frame of the header: a transform of tf2_msgs/TFMessage, geometry_msgs/TransformStamped,
/// PoseStamped, PoseWithCovarianceStamped (no child) or nav_msgs/Odometry.
struct RosPose {
  RosHeader header;
  std::string child;  // empty where the message does not say whose pose it is
  Pose parent_from_child = Pose::Identity();
};
[[nodiscard]] std::vector<RosPose> read_transforms(MessageReader& reader);

/// Whether read_pose_message() knows the type ("geometry_msgs/PoseStamped").
[[nodiscard]] bool is_pose_type(std::string_view type);
[[nodiscard]] RosPose read_pose_message(MessageReader& reader, std::string_view type);

}  // namespace vantage
