#pragma once

#include <string>

#include "vantage/core/triangle_mesh.hpp"

namespace vantage::app {

/// An object to be scanned in simulation.
struct ObjectSource {
  std::string name;  // what people call it
  TriangleMesh mesh;
  double default_size = 0.815;  // metres, of the largest side
};

/// A built-in object by its name, or a mesh file by its path. Throws InputError that lists the names where it is
/// neither.
[[nodiscard]] ObjectSource find_object(const std::string& name_or_path);

}  // namespace vantage::app
