#include "readers.hpp"

#include "vantage/io/camera_file.hpp"
#include "vantage/io/conf_file.hpp"
#include "vantage/io/depth_image.hpp"
#include "vantage/io/map_file.hpp"
#include "vantage/io/mesh_file.hpp"
#include "vantage/io/nrrd.hpp"
#include "vantage/io/options.hpp"
#include "vantage/io/point_cloud_file.hpp"
#include "vantage/io/pose_file.hpp"

namespace vantage::fuzz {
namespace {

struct Options {
  bool flag = false;
  int number = 0;
  std::string text;
  Vec3 vector = Vec3::Zero();
  std::optional<double> maybe;
};

template <class Field>
void describe(Options& o, Field&& field) {
  field("flag", o.flag, "", "");
  field("number", o.number, "", "");
  field("text", o.text, "", "");
  field("vector", o.vector, "m", "");
  field("maybe", o.maybe, "m", "");
}

void read_options(std::string_view bytes) {
  Options options;
  set_options_from_yaml(option_fields(options), bytes, "input");
}

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

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all{
      {"mesh_ply", read_mesh_as<MeshFormat::ply>},
      {"mesh_obj", read_mesh_as<MeshFormat::obj>},
      {"mesh_stl", read_mesh_as<MeshFormat::stl>},
      {"mesh_off", read_mesh_as<MeshFormat::off>},
      {"cloud_ply", read_cloud_as<CloudFormat::ply>},
      {"cloud_pcd", read_cloud_as<CloudFormat::pcd>},
      {"cloud_xyzn", read_cloud_as<CloudFormat::xyzn>},
      {"depth_png", [](std::string_view bytes) { (void)decode_png16(bytes, "input"); }},
      {"map_labels",
       [](std::string_view bytes) {
         (void)parse_map({"input", bytes}, std::nullopt);
       }},
      {"map_surface", read_map_surface},
      {"intrinsics_text", [](std::string_view bytes) { (void)parse_intrinsics_text(bytes, "input"); }},
      {"intrinsics_yaml", [](std::string_view bytes) { (void)parse_intrinsics_yaml(bytes, "input"); }},
      {"intrinsics_json", [](std::string_view bytes) { (void)parse_intrinsics_json(bytes, "input"); }},
      {"pose_text", [](std::string_view bytes) { (void)parse_pose_text(bytes, "input"); }},
      {"pose_json", [](std::string_view bytes) { (void)parse_pose_json(bytes, "input"); }},
      {"trajectory", [](std::string_view bytes) { (void)parse_trajectory(bytes, "input"); }},
      {"conf", [](std::string_view bytes) { (void)parse_conf(bytes, "input"); }},
      {"options", read_options},
  };
  return all;
}

}  // namespace vantage::fuzz
