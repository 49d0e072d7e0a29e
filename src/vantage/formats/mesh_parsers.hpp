#pragma once

#include <string>
#include <string_view>

#include "vantage/core/triangle_mesh.hpp"

// One parser per mesh format; parse_mesh() in mesh_file.hpp calls them and checks the surface as a whole. Each throws
// InputError with `name` and the place.
namespace vantage {

[[nodiscard]] TriangleMesh parse_ply_mesh(std::string_view bytes, const std::string& name);
[[nodiscard]] TriangleMesh parse_obj_mesh(std::string_view bytes, const std::string& name);
[[nodiscard]] TriangleMesh parse_off_mesh(std::string_view bytes, const std::string& name);
[[nodiscard]] TriangleMesh parse_stl_mesh(std::string_view bytes, const std::string& name);

}  // namespace vantage
