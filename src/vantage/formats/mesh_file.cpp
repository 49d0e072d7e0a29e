#include "vantage/formats/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/mesh_parsers.hpp"
#include "vantage/formats/ply.hpp"

namespace vantage {
namespace {

constexpr double least_size = 1e-9, most_size = 1e9;  // beyond them squares and cubes of lengths lose their meaning

void check_surface(const TriangleMesh& mesh, const std::string& name) {
  if (mesh.triangles.empty()) throw InputError(name + ": has no triangles; a mesh with a surface is needed");
  Box3 box;
  double twice_area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) box.extend(mesh.corner(t, k));
    twice_area += (mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0)).norm();
  }
  const double size = box.sizes().maxCoeff();
  if (size == 0) throw InputError(name + ": has no extent, all its triangles lie in one point");
  if (!(size >= least_size && size <= most_size) || box.center().cwiseAbs().maxCoeff() > most_size) {
    throw InputError(
        fmt::format("{}: its largest side is {} at a distance of {} from the origin: must be within {} and {}", name,
                    size, box.center().cwiseAbs().maxCoeff(), least_size, most_size));
  }
  if (!(twice_area > 0)) throw InputError(name + ": no triangle has an area");
}

}  // namespace

MeshFormat mesh_format(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".ply") return MeshFormat::ply;
  if (ending == ".obj") return MeshFormat::obj;
  if (ending == ".stl") return MeshFormat::stl;
  if (ending == ".off") return MeshFormat::off;
  throw InputError(fmt::format("{}: a mesh must be a .ply, .obj, .stl or .off file", path.string()));
}

TriangleMesh parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name) {
  if (bytes.empty()) throw InputError(name + ": is empty");
  TriangleMesh mesh;
  switch (format) {
    case MeshFormat::ply:
      mesh = parse_ply_mesh(bytes, name);
      break;
    case MeshFormat::obj:
      mesh = parse_obj_mesh(bytes, name);
      break;
    case MeshFormat::stl:
      mesh = parse_stl_mesh(bytes, name);
      break;
    case MeshFormat::off:
      mesh = parse_off_mesh(bytes, name);
      break;
  }
  check_surface(mesh, name);
  return mesh;
}

TriangleMesh read_mesh(const std::filesystem::path& path) {
  const MeshFormat format = mesh_format(path);
  return parse_mesh(read_file(path), format, path.string());
}

MeasuredMesh read_measured_mesh(const std::filesystem::path& path) {
  const std::string bytes = read_file(path), name = path.string();
  MeasuredMesh measured;
  measured.mesh = parse_mesh(bytes, MeshFormat::ply, name);
  const Ply ply = parse_ply(bytes, name);
  const PlyElement& vertices = *ply.find("vertex");
  const auto scalar = [](const PlyElement& element, const char* property) {
    const PlyColumn* column = element.find(property);
    return column != nullptr && !column->is_list ? column : nullptr;
  };
  if (const PlyColumn* sigma = scalar(vertices, "sigma")) {
    for (const double value : sigma->values) {
      require(std::isfinite(value) && value >= 0, name, ": a sigma is ", value, ": must not be negative");
      measured.sigma.push_back(static_cast<float>(value));
    }
  }
  const std::array<const PlyColumn*, 3> color{scalar(vertices, "red"), scalar(vertices, "green"),
                                              scalar(vertices, "blue")};
  if (color[0] != nullptr && color[1] != nullptr && color[2] != nullptr) {
    const auto byte = [](double value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)); };
    for (std::size_t i = 0; i < vertices.rows; ++i)
      measured.colors.push_back({byte(color[0]->values[i]), byte(color[1]->values[i]), byte(color[2]->values[i])});
  }
  const PlyElement& faces = *ply.find("face");
  const PlyColumn* cap = scalar(faces, "cap");
  // Polygons that were cut or left out have no mark of their own.
  if (cap != nullptr && faces.rows == measured.mesh.triangles.size()) {
    for (const double value : cap->values) measured.is_cap.push_back(value != 0 ? 1 : 0);
  }
  return measured;
}

void write_mesh_ply(const std::filesystem::path& path, const TriangleMesh& mesh) {
  write_measured_mesh_ply(path, {.mesh = mesh, .sigma = {}, .is_cap = {}, .colors = {}});
}

void write_measured_mesh_ply(const std::filesystem::path& path, const MeasuredMesh& measured) {
  const TriangleMesh& mesh = measured.mesh;
  const bool has_caps = std::find(measured.is_cap.begin(), measured.is_cap.end(), 1) != measured.is_cap.end();
  PlyMeshHeader header{.vertices = mesh.vertices.size(), .triangles = mesh.triangles.size()};
  if (!measured.sigma.empty()) header.vertex_properties.emplace_back("float sigma");
  if (!measured.colors.empty()) {
    for (const char* color : {"uchar red", "uchar green", "uchar blue"}) header.vertex_properties.emplace_back(color);
  }
  if (has_caps) header.face_properties.emplace_back("uchar cap");
  AtomicFile file(path);
  header.coordinates = coordinates_for(mesh.vertices);
  file.write(ply_mesh_header(header));
  std::string row;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    row.clear();
    append_point(row, mesh.vertices[i], header.coordinates);
    if (!measured.sigma.empty()) append_float32(row, static_cast<double>(measured.sigma[i]));
    if (!measured.colors.empty()) row.append(measured.colors[i].begin(), measured.colors[i].end());
    file.write(row);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    row.assign(1, '\x03');
    for (const int index : mesh.triangles[i]) append_int32(row, index);
    if (has_caps) row.push_back(static_cast<char>(measured.is_cap[i]));
    file.write(row);
  }
  file.commit();
}

}  // namespace vantage
