#pragma once

#include <string>
#include <vector>

#include "vantage/core/triangle_mesh.hpp"

namespace vantage {

/// Names of the built-in objects, in the order of the paper's tables.
[[nodiscard]] std::vector<std::string> object_names();

/// The largest side of a built-in object in metres for which it occupies about as many voxels as in the paper (spec,
/// section 9). Throws InputError that lists the names where `name` is none.
[[nodiscard]] double default_size(const std::string& name);

/// A built-in object at its default size, centred at the origin, z up: closed, facing outwards, each edge shared by
/// two triangles. Throws InputError that lists the names where `name` is none.
[[nodiscard]] TriangleMesh make_object(const std::string& name);

}  // namespace vantage
