#include "object_source.hpp"

#include <algorithm>
#include <filesystem>

#include "vantage/core/error.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/simulation/objects.hpp"

namespace vantage::app {

ObjectSource find_object(const std::string& name_or_path) {
  const std::vector<std::string> names = object_names();
  if (std::find(names.begin(), names.end(), name_or_path) != names.end()) {
    return {name_or_path, make_object(name_or_path), default_size(name_or_path)};
  }
  const std::filesystem::path path(name_or_path);
  if (path.has_extension() || std::filesystem::exists(path)) {
    return {path.stem().string(), read_mesh(path), 0.815};
  }
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  throw InputError(concat("object '", name_or_path, "' is neither a built-in one (", list,
                          ") nor the path of a mesh (.ply, .obj, .stl, .off)"));
}

}  // namespace vantage::app
