#include "vantage/experiments/paper.hpp"

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/simulation/objects.hpp"

namespace vantage {
namespace {

std::optional<PaperObject> find(const PublishedObject& published, const std::optional<std::filesystem::path>& folder) {
  if (folder) {
    require(std::filesystem::is_directory(*folder), "objects = ", folder->string(), ": must be a folder of meshes");
    const std::string file = concat(published.name, ".ply");
    if (std::filesystem::exists(*folder / file)) {
      return PaperObject{
          published, std::make_shared<SweepObject>(published.name, read_mesh(*folder / file), published.size, file)};
    }
  }
  const std::vector<std::string> names = object_names();
  if (std::find(names.begin(), names.end(), published.name) == names.end()) return std::nullopt;
  return PaperObject{published, std::make_shared<SweepObject>(published.name, make_object(published.name),
                                                              default_size(published.name), "built in")};
}

}  // namespace

std::vector<PaperObject> paper_objects(const std::optional<std::filesystem::path>& folder) {
  std::vector<PaperObject> objects;
  for (const PublishedObject& published : published_objects) {
    if (auto object = find(published, folder)) objects.push_back(std::move(*object));
  }
  return objects;
}

PaperObject paper_object(const std::string& name, const std::optional<std::filesystem::path>& folder) {
  for (const PublishedObject& published : published_objects) {
    if (name != published.name) continue;
    if (auto object = find(published, folder)) return std::move(*object);
    throw InputError(
        concat("object '", name, "' is not built in: give a folder that holds ", name, ".ply with --objects"));
  }
  throw InputError(concat("object '", name, "' is none of the paper's"));
}

}  // namespace vantage
