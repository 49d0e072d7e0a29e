#include "vantage/simulation/objects.hpp"

#include <algorithm>
#include <array>

#include "vantage/core/error.hpp"
#include "vantage/simulation/mesh_tools.hpp"
#include "vantage/simulation/object_shapes.hpp"

namespace vantage {
namespace {

struct BuiltIn {
  const char* name;
  double size;  // metres
  TriangleMesh (*shape)();
};

constexpr std::array built_in{
    BuiltIn{"sphere", 0.815, sphere_shape},    BuiltIn{"pear", 0.815, pear_shape},
    BuiltIn{"banana", 0.815, banana_shape},    BuiltIn{"mug", 0.815, mug_shape},
    BuiltIn{"sgi_logo", 1.09, sgi_logo_shape},
};

const BuiltIn& find(const std::string& name) {
  const auto* const found =
      std::find_if(built_in.begin(), built_in.end(), [&](const BuiltIn& b) { return b.name == name; });
  if (found == built_in.end()) {
    std::string names;
    for (const BuiltIn& object : built_in) names += (names.empty() ? "" : ", ") + std::string(object.name);
    throw InputError(concat("object '", name, "' is not built in; must be one of ", names));
  }
  return *found;
}

}  // namespace

std::vector<std::string> object_names() {
  std::vector<std::string> names;
  for (const BuiltIn& object : built_in) names.emplace_back(object.name);
  return names;
}

double default_size(const std::string& name) { return find(name).size; }

TriangleMesh make_object(const std::string& name) {
  const BuiltIn& object = find(name);
  TriangleMesh mesh = object.shape();
  // Sines and powers have other last bits on other machines; rounding takes them off.
  constexpr double steps = 0x1p30;
  for (Vec3& vertex : mesh.vertices) vertex = (vertex * steps).array().round() / steps;
  return centred_and_scaled(std::move(mesh), object.size);
}

}  // namespace vantage
