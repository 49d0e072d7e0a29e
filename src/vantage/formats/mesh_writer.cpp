#include "vantage/formats/mesh_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/formats/ply.hpp"

namespace vantage {
namespace {

std::string lower_case_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

Vec3 area_normal(const TriangleMesh& mesh, std::size_t triangle) {
  const Vec3 first = mesh.corner(triangle, 0);
  return (mesh.corner(triangle, 1) - first).cross(mesh.corner(triangle, 2) - first);
}

}  // namespace

void write_mesh(const std::filesystem::path& path, const MeasuredMesh& mesh) {
  const std::string ending = lower_case_ending(path);
  if (ending == ".ply") {
    write_measured_mesh_ply(path, mesh);
  } else if (ending == ".stl") {
    write_file_atomically(path, stl_bytes(mesh.mesh));
  } else if (ending == ".obj") {
    write_file_atomically(path, obj_text(mesh));
  } else if (ending == ".glb") {
    write_file_atomically(path, glb_bytes(mesh));
  } else {
    throw InputError(fmt::format("{}: a mesh is written as .glb, .obj, .stl or .ply", path.string()));
  }
}

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 normal = area_normal(mesh, t);
    for (int k = 0; k < 3; ++k) normals[static_cast<std::size_t>(mesh.triangles[t][k])] += normal;
  }
  for (Vec3& normal : normals) normal = normal.squaredNorm() > 0 ? Vec3(normal.normalized()) : Vec3(Vec3::UnitZ());
  return normals;
}

std::string stl_bytes(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  constexpr std::string_view title = "vantage mesh, metres";  // a first word `solid` would announce the text format
  std::copy(title.begin(), title.end(), bytes.begin());
  append_int32(bytes, static_cast<std::int32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Vec3 normal = area_normal(mesh, t);
    normal = normal.squaredNorm() > 0 ? Vec3(normal.normalized()) : Vec3(Vec3::Zero());
    for (const double part : normal) append_float32(bytes, part);
    for (int k = 0; k < 3; ++k) {
      for (const double part : mesh.corner(t, k)) append_float32(bytes, part);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string obj_text(const MeasuredMesh& measured) {
  const TriangleMesh& mesh = measured.mesh;
  fmt::memory_buffer text;
  fmt::format_to(fmt::appender(text), "# metres\n");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f place = mesh.vertices[i].cast<float>();
    fmt::format_to(fmt::appender(text), "v {} {} {}", place.x(), place.y(), place.z());
    if (!measured.colors.empty()) {
      for (const std::uint8_t part : measured.colors[i]) fmt::format_to(fmt::appender(text), " {:.4g}", part / 255.0);
    }
    fmt::format_to(fmt::appender(text), "\n");
  }
  for (const int cap : {0, 1}) {
    bool is_first = true;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if ((measured.is_cap.empty() ? 0 : measured.is_cap[t]) != cap) continue;
      if (std::exchange(is_first, false)) fmt::format_to(fmt::appender(text), "g {}\n", cap != 0 ? "cap" : "seen");
      const Index3 from_one = mesh.triangles[t] + Index3::Ones();
      fmt::format_to(fmt::appender(text), "f {} {} {}\n", from_one.x(), from_one.y(), from_one.z());
    }
  }
  return fmt::to_string(text);
}

}  // namespace vantage
