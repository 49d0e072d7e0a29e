#include "vantage/recordings/scan_bytes.hpp"

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/files/option_text.hpp"
#include "vantage/formats/lens.hpp"
#include "vantage/formats/pose_file.hpp"
#include "vantage/sensor/organised_normals.hpp"

namespace vantage {
namespace {

std::optional<Box3> crop_box(const ScanFolderOptions& options) {
  if (!options.crop) return std::nullopt;
  const Vec3 center = options.crop->head<3>(), half = 0.5 * options.crop->tail<3>();
  return Box3(center - half, center + half);
}

RangeImage without_outside(RangeImage image, const Box3& box, const Pose& world_from_sensor) {
  const RayGrid rays = image.camera.rays();
  std::size_t pixel = 0;
  for (int row = 0; row < image.camera.resolution.rows; ++row) {
    for (int column = 0; column < image.camera.resolution.columns; ++column, ++pixel) {
      const float depth = image.depth[pixel];
      if (RangeImage::is_hit(depth) &&
          !box.contains(world_from_sensor * point_in_sensor(rays, column, row, static_cast<double>(depth)))) {
        image.depth[pixel] = RangeImage::unknown;
      }
    }
  }
  return image;
}

PointScan without_outside(const PointScan& scan, const Box3& box, const Pose& world_from_sensor) {
  PointScan inside;
  inside.axis = scan.axis;
  const bool one_origin = scan.origins.size() == 1;
  if (one_origin) inside.origins = scan.origins;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (!box.contains(world_from_sensor * scan.points[i])) continue;
    inside.points.push_back(scan.points[i]);
    if (!scan.normals.empty()) inside.normals.push_back(scan.normals[i]);
    if (!one_origin) inside.origins.push_back(scan.origins[i]);
  }
  return inside;
}

RangeImage depths_of(const DepthPixels& pixels, const Intrinsics& intrinsics, const std::optional<Mask>& mask,
                     const ScanFolderOptions& options) {
  const auto depths = [&](const auto& image) {
    RangeCamera camera = pinhole_camera(intrinsics, image.resolution);
    camera.min_depth = options.depth_range[0];
    camera.max_depth = options.depth_range[1];
    auto counted = mask ? masked(image, *mask) : image;
    return range_image(undistorted(std::move(counted), intrinsics), camera, depth_encoding(options));
  };
  return std::visit(depths, pixels);
}

}  // namespace

DepthEncoding depth_encoding(const ScanFolderOptions& options) {
  DepthEncoding encoding{.metres_per_unit = options.metres_per_depth_unit(), .no_return = std::nullopt};
  encoding.metres_per_float = options.metres_per_unit();
  encoding.unknown = options.unknown;
  encoding.along = options.depth_along;
  if (options.no_return) encoding.no_return = static_cast<std::uint16_t>(*options.no_return);
  return encoding;
}

Pose hand_eye_offset(const ScanFolderOptions& options) {
  if (options.hand_eye.empty()) return Pose::Identity();
  if (options.hand_eye_is_file()) {
    Pose offset = read_pose(options.hand_eye);
    offset.translation() *= options.metres_per_unit();
    return offset;
  }
  const std::vector<double> n = numbers_from_text("hand-eye", options.hand_eye, 7);
  return pose_from_quaternion(options.metres_per_unit() * Vec3(n[0], n[1], n[2]),
                              Eigen::Quaterniond(n[6], n[3], n[4], n[5]), "hand-eye");
}

Pose sensor_pose(const Pose& read, const Pose& hand_eye, const ScanFolderOptions& options) {
  Pose hand = read;
  hand.translation() *= options.metres_per_unit();
  return options.hand_eye.empty() ? hand : Pose(hand * hand_eye);
}

Scan scan_of_depth(const DepthPixels& pixels, const Intrinsics& intrinsics, const std::optional<Mask>& mask,
                   const ScanFolderOptions& options) {
  return scan_of(depths_of(pixels, intrinsics, mask, options));
}

Scan scan_of_depth(const DepthPixels& pixels, const Intrinsics& intrinsics, const std::optional<Mask>& mask,
                   const View& believed, const ScanFolderOptions& options) {
  RangeImage depths = depths_of(pixels, intrinsics, mask, options);
  if (const auto box = crop_box(options)) depths = without_outside(std::move(depths), *box, believed.world_from_sensor);
  return scan_of(std::move(depths));  // normals last, and once
}

Scan scan_of_cloud(const CloudFile& file, const Pose& world_from_sensor, const ScanFolderOptions& options) {
  const double metres = options.metres_per_unit();
  Pose sensor_from_cloud = file.cloud_from_sensor.inverse();
  sensor_from_cloud.translation() *= metres;
  if (options.cloud_frame == "world") sensor_from_cloud = world_from_sensor.inverse();
  PointScan scan;
  scan.origins = {Vec3::Zero()};
  for (const Vec3& point : file.cloud.points) scan.points.push_back(sensor_from_cloud * Vec3(metres * point));
  const bool has_normals =
      std::any_of(file.cloud.normals.begin(), file.cloud.normals.end(), [](const Vec3& n) { return !n.isZero(0); });
  if (has_normals) {
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Vec3 normal = sensor_from_cloud.linear() * file.cloud.normals[i];
      scan.normals.push_back((normal.dot(scan.points[i]) > 0 ? Vec3(-normal) : normal).cast<float>());
    }
  } else if (file.grid.rows > 0) {
    scan.normals = organised_normals(file.grid, file.point_of_cell, scan.points, scan.origins);
  }
  return scan;
}

Scan cropped(Scan scan, const View& believed, const ScanFolderOptions& options) {
  const std::optional<Box3> box = crop_box(options);
  if (!box) return scan;
  if (auto* image = std::get_if<ImageScan>(&scan))
    return scan_of(without_outside(std::move(image->image), *box, believed.world_from_sensor));
  return without_outside(std::get<PointScan>(scan), *box, believed.world_from_sensor);
}

}  // namespace vantage
