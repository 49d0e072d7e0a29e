#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vantage/core/measured_mesh.hpp"

namespace vantage {

enum class MeshFormat { ply, obj, stl, off };

/// The format that the ending of the name stands for (.ply, .obj, .stl, .off, in any case); throws InputError for
/// others.
[[nodiscard]] MeshFormat mesh_format(const std::filesystem::path& path);

/// The triangles of a PLY (ASCII or binary), OBJ, STL (ASCII or binary) or OFF file, in the file's unit and frame.
/// Polygons are cut into triangles, vertices of an STL that are equal to the bit become one, and triangles with a
/// repeated vertex are left out. Throws InputError naming the file and the place: empty, cut off or of another format;
/// a coordinate that is not finite; an index out of range; no triangle, or none with an area; an absurd size.
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& path);
/// The same from memory; `name` is used in errors.
[[nodiscard]] TriangleMesh parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name);

/// Binary little endian, float32, triangles as `list uchar int vertex_indices`; replaces the file atomically.
void write_mesh_ply(const std::filesystem::path& path, const TriangleMesh& mesh);
/// The same with what was measured: `float sigma` (metres) per vertex, `uchar red, green, blue` where there are
/// colours, and `uchar cap` per triangle where some were not seen.
void write_measured_mesh_ply(const std::filesystem::path& path, const MeasuredMesh& mesh);
/// A PLY mesh with what such a file says beside the triangles; errors as read_mesh.
[[nodiscard]] MeasuredMesh read_measured_mesh(const std::filesystem::path& path);

}  // namespace vantage
