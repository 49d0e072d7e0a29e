#pragma once

#include <filesystem>
#include <string>

#include "vantage/core/measured_mesh.hpp"

namespace vantage {

/// Writes a measured mesh as the ending of the name says, in any case, atomically:
///   .ply  binary: positions, `sigma`, colours, and `cap` for triangles that were not seen (write_measured_mesh_ply)
///   .stl  binary: triangles only
///   .obj  positions, colours behind the coordinates; groups `seen` and `cap`
///   .glb  glTF 2.0: positions, normals, colours, `_SIGMA`; caps with a material of their own; turned to y up
/// Lengths are metres. Throws InputError for other endings.
void write_mesh(const std::filesystem::path& path, const MeasuredMesh& mesh);

/// The bytes of these files.
[[nodiscard]] std::string stl_bytes(const TriangleMesh& mesh);
[[nodiscard]] std::string obj_text(const MeasuredMesh& mesh);
[[nodiscard]] std::string glb_bytes(const MeasuredMesh& mesh);

/// Unit normals of the vertices: the mean of those of the triangles around, weighted by area.
[[nodiscard]] std::vector<Vec3> vertex_normals(const TriangleMesh& mesh);

}  // namespace vantage
