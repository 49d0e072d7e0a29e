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

void write_mesh_ply(const std::filesystem::path& path, const TriangleMesh& mesh) {
  AtomicFile file(path);
  const Coordinates coordinates = coordinates_for(mesh.vertices);
  file.write(ply_header(mesh.vertices.size(), coordinates, {}, mesh.triangles.size()));
  std::string row;
  for (const Vec3& vertex : mesh.vertices) {
    row.clear();
    append_point(row, vertex, coordinates);
    file.write(row);
  }
  for (const Index3& triangle : mesh.triangles) {
    row.assign(1, '\x03');
    for (const int index : triangle) append_int32(row, index);
    file.write(row);
  }
  file.commit();
}

}  // namespace vantage
