#include "readers.hpp"

#include <nlohmann/json.hpp>

#include "vantage/arm/arm_description.hpp"
#include "vantage/core/error.hpp"
#include "vantage/doctor/pose_files.hpp"
#include "vantage/experiments/run_outcome.hpp"
#include "vantage/files/json_text.hpp"
#include "vantage/formats/camera_file.hpp"
#include "vantage/formats/colmap_file.hpp"
#include "vantage/formats/conf_file.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/formats/exr.hpp"
#include "vantage/formats/float_images.hpp"
#include "vantage/formats/map_file.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/formats/nrrd.hpp"
#include "vantage/formats/point_cloud_file.hpp"
#include "vantage/formats/pose_file.hpp"
#include "vantage/formats/pose_list.hpp"
#include "vantage/formats/tiff.hpp"
#include "vantage/runs/stored_run_files.hpp"
#include "vantage/session/sealed_file.hpp"
#include "vantage/session/session_scan.hpp"
#include "vantage/session/skipped_views.hpp"

namespace vantage::fuzz {
namespace {

/// The surface file of a map whose labels are given: two occupied voxels of four.
void read_map_surface(std::string_view bytes) {
  const Grid grid{Vec3::Zero(), 1, {4, 1, 1}};
  const std::string labels = nrrd_header(grid, grid.all()) + std::string("\1\2\1\0", 4);
  (void)parse_map({"labels", labels}, NamedBytes{"input", bytes});
}

template <MeshFormat format>
void read_mesh_as(std::string_view bytes) {
  (void)parse_mesh(bytes, format, "input");
}

template <CloudFormat format>
void read_cloud_as(std::string_view bytes) {
  (void)parse_cloud(bytes, format, "input");
}

void read_urdf(std::string_view bytes) {
  (void)arm_from_urdf(bytes, "input", "camera",
                      [](const std::string&) { return Box3(Vec3::Constant(-0.1), Vec3::Constant(0.1)); });
}

void read_raw_pose(std::string_view bytes) {
  const auto matrix = parse_raw_pose(bytes);
  require(matrix.has_value(), "input: has not 16 numbers");
  const std::vector<RawPose> poses{{"input", *matrix}};
  (void)check_rotations(poses);
  for (int flipped = 0; flipped < 4; ++flipped) (void)fixed(poses, flipped);
}

void read_raw_depth(std::string_view bytes) {
  const RangeCamera camera = camera_from_intrinsics(2, 2, 1, 0.5, {3, 2});
  const DepthPixels pixels = decode_depth(bytes, camera.resolution, "input");
  (void)std::visit([&](const auto& image) { return range_image(image, camera, {}); }, pixels);
}

void read_outcome(std::string_view bytes) {
  const nlohmann::json json = parse_json(bytes, "input");
  require(json.is_object(), "input: must be an object");
  (void)outcome_from_json(json.value("outcome", nlohmann::json()), json.value("times", nlohmann::json()), "input");
}

}  // namespace

const std::vector<Reader>& file_readers() {
  using Bytes = std::string_view;
  static const std::vector<Reader> all{
      {"mesh_ply", "ply", read_mesh_as<MeshFormat::ply>},
      {"cloud_ply", "ply", read_cloud_as<CloudFormat::ply>},
      {"mesh_obj", "mesh", read_mesh_as<MeshFormat::obj>},
      {"mesh_stl", "mesh", read_mesh_as<MeshFormat::stl>},
      {"mesh_off", "mesh", read_mesh_as<MeshFormat::off>},
      {"cloud_pcd", "pcd", read_cloud_as<CloudFormat::pcd>},
      {"cloud_xyz", "text", read_cloud_as<CloudFormat::xyz>},
      {"cloud_xyzn", "text", read_cloud_as<CloudFormat::xyzn>},
      {"intrinsics_text", "text", [](Bytes bytes) { (void)parse_intrinsics_text(bytes, "input"); }},
      {"pose_text", "text", [](Bytes bytes) { (void)parse_pose_text(bytes, "input"); }},
      {"raw_pose", "text", read_raw_pose},
      {"pose_list", "text", [](Bytes bytes) { (void)parse_pose_list(bytes, "input"); }},
      {"colmap_cameras", "text", [](Bytes bytes) { (void)parse_colmap_cameras(bytes, "input"); }},
      {"colmap_images", "text", [](Bytes bytes) { (void)parse_colmap_images(bytes, "input"); }},
      {"trajectory", "text", [](Bytes bytes) { (void)parse_trajectory(bytes, "input"); }},
      {"conf", "text", [](Bytes bytes) { (void)parse_conf(bytes, "input"); }},
      {"depth_png", "image", [](Bytes bytes) { (void)decode_png16(bytes, "input"); }},
      {"depth_raw", "image", read_raw_depth},
      {"mask_png", "image",
       [](Bytes bytes) {
         (void)decode_png_mask(bytes, {3, 2}, "input");
       }},
      {"depth_npy", "image", [](Bytes bytes) { (void)decode_npy(bytes, "input"); }},
      {"depth_pfm", "image", [](Bytes bytes) { (void)decode_pfm(bytes, "input"); }},
      {"confidence_png", "image",
       [](Bytes bytes) {
         (void)decode_png_grey(bytes, {3, 2}, "input");
       }},
      {"depth_tiff", "image", [](Bytes bytes) { (void)decode_tiff(bytes, "input"); }},
      {"exr", "image", [](Bytes bytes) { (void)decode_exr(bytes, "input"); }},
      {"map_labels", "map",
       [](Bytes bytes) {
         (void)parse_map({"input", bytes}, std::nullopt);
       }},
      {"map_surface", "map", read_map_surface},
      {"intrinsics_yaml", "yaml", [](Bytes bytes) { (void)parse_intrinsics_yaml(bytes, "input"); }},
      {"run_config", "yaml", [](Bytes bytes) { (void)parse_run_config(bytes, "input"); }},
      {"urdf", "urdf", read_urdf},
      {"intrinsics_json", "json", [](Bytes bytes) { (void)parse_intrinsics_json(bytes, "input"); }},
      {"pose_json", "json", [](Bytes bytes) { (void)parse_pose_json(bytes, "input"); }},
      {"run_summary", "json", [](Bytes bytes) { (void)parse_run_summary(bytes, "input"); }},
      {"run_outcome", "json", read_outcome},
      {"session_located", "json", [](Bytes bytes) { (void)parse_located(bytes, "input"); }},
      {"session_skipped", "json", [](Bytes bytes) { (void)parse_skipped_views(bytes, "input"); }},
      {"session_scan", "scan",
       [](Bytes bytes) {
         try {
           (void)parse_scan(bytes, "input");
         } catch (const NewerFormat&) {
           // Left as it is.
         }
       }},
      {"sealed", "scan", [](Bytes bytes) { (void)unsealed(bytes, "input"); }},
  };
  return all;
}

}  // namespace vantage::fuzz
