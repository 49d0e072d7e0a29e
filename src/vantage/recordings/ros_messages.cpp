#include "vantage/recordings/ros_messages.hpp"

#include <cmath>

namespace vantage {
namespace {

std::string ros_frame_name(std::string name) {
  while (!name.empty() && name.front() == '/') name.erase(0, 1);
  return name;
}

template <std::size_t Count>
std::array<double, Count> f64s(MessageReader& reader) {
  std::array<double, Count> values{};
  for (double& value : values) value = reader.f64();
  return values;
}

/// Translation and quaternion (w last), as Pose and Transform have them.
Pose read_rigid(MessageReader& reader) {
  const auto t = f64s<3>(reader);
  const auto q = f64s<4>(reader);
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  const bool is_finite =
      std::isfinite(t[0]) && std::isfinite(t[1]) && std::isfinite(t[2]) && std::isfinite(rotation.norm());
  if (!is_finite) reader.fail("a pose has numbers that are not finite");
  if (std::abs(rotation.norm() - 1) > 1e-2)
    reader.fail(concat("a rotation is a quaternion of length ", rotation.norm(), ", must be 1"));
  Pose pose = Pose::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = Vec3(t[0], t[1], t[2]);
  return pose;
}

RosPose read_transform(MessageReader& reader) {
  RosPose pose;
  pose.header = read_header(reader);
  pose.child = ros_frame_name(reader.text());
  pose.parent_from_child = read_rigid(reader);
  return pose;
}

}  // namespace

RosHeader read_header(MessageReader& reader) {
  if (reader.serialization() == Serialization::ros1) (void)reader.u32();  // seq, which ROS 2 has no more
  RosHeader header;
  const std::int64_t seconds =
      reader.serialization() == Serialization::ros1 ? std::int64_t{reader.u32()} : std::int64_t{reader.i32()};
  header.stamp_ns = seconds * 1'000'000'000 + std::int64_t{reader.u32()};
  header.frame_id = ros_frame_name(reader.text());
  return header;
}

RosImage read_image(MessageReader& reader) {
  RosImage image;
  image.header = read_header(reader);
  image.height = reader.u32();
  image.width = reader.u32();
  image.encoding = reader.text();
  image.is_big_endian = reader.u8() != 0;
  image.step = reader.u32();
  image.data = reader.byte_list();
  return image;
}

RosCompressedImage read_compressed_image(MessageReader& reader) {
  RosCompressedImage image;
  image.header = read_header(reader);
  image.format = reader.text();
  image.data = reader.byte_list();
  return image;
}

RosCameraInfo read_camera_info(MessageReader& reader) {
  RosCameraInfo info;
  info.header = read_header(reader);
  info.height = reader.u32();
  info.width = reader.u32();
  info.distortion_model = reader.text();
  const std::uint32_t coefficients = reader.list_size(8);
  for (std::uint32_t i = 0; i < coefficients; ++i) info.distortion.push_back(reader.f64());
  info.k = f64s<9>(reader);
  (void)f64s<9>(reader);  // R, the rotation between the cameras of a stereo pair
  info.p = f64s<12>(reader);
  info.binning_x = reader.u32();
  info.binning_y = reader.u32();
  info.roi_x = reader.u32();
  info.roi_y = reader.u32();
  info.roi_height = reader.u32();
  info.roi_width = reader.u32();
  return info;
}

RosPointCloud read_point_cloud(MessageReader& reader) {
  RosPointCloud cloud;
  cloud.header = read_header(reader);
  cloud.height = reader.u32();
  cloud.width = reader.u32();
  const std::uint32_t fields = reader.list_size(4 + 4 + 1 + 4);
  for (std::uint32_t i = 0; i < fields; ++i) {
    RosPointField field;
    field.name = reader.text();
    field.offset = reader.u32();
    field.type = reader.u8();
    (void)reader.u32();  // how many of it; coordinates are single numbers
    cloud.fields.push_back(std::move(field));
  }
  cloud.is_big_endian = reader.u8() != 0;
  cloud.point_step = reader.u32();
  cloud.row_step = reader.u32();
  cloud.data = reader.byte_list();
  return cloud;
}

std::vector<RosPose> read_transforms(MessageReader& reader) {
  const std::uint32_t count = reader.list_size(64);
  std::vector<RosPose> transforms;
  for (std::uint32_t i = 0; i < count; ++i) transforms.push_back(read_transform(reader));
  return transforms;
}

bool is_pose_type(std::string_view type) {
  return type == "geometry_msgs/PoseStamped" || type == "geometry_msgs/PoseWithCovarianceStamped" ||
         type == "geometry_msgs/TransformStamped" || type == "nav_msgs/Odometry";
}

RosPose read_pose_message(MessageReader& reader, std::string_view type) {
  if (type == "geometry_msgs/TransformStamped") return read_transform(reader);
  RosPose pose;
  pose.header = read_header(reader);
  if (type == "nav_msgs/Odometry") pose.child = ros_frame_name(reader.text());
  pose.parent_from_child = read_rigid(reader);
  return pose;
}

}  // namespace vantage
