#include "vantage/experiments/robustness_options.hpp"

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/core/text.hpp"
#include "vantage/experiments/paper.hpp"
#include "vantage/formats/mesh_file.hpp"

namespace vantage {
namespace {

constexpr double object_size = 0.815;  // metres, largest side, of most of the paper's objects

}  // namespace

void RobustnessOptions::validate() const {
  require(seeds >= 1 && seeds <= 10'000, "robustness-seeds = ", seeds, ": must be in 1..10000");
  require(first_seed >= 0, "robustness-first-seed = ", first_seed, ": must not be negative");
  for (const Deviation& error : deviations()) {
    for (const std::string& registration : registration_list()) run_options(error, registration).validate();
  }
}

std::vector<RobustnessOptions::Deviation> RobustnessOptions::deviations() const {
  std::vector<Deviation> list;
  for (const std::string& part : split(errors, ',')) {
    const std::vector<std::string> both = split(part, ':');
    require(both.size() == 2, "robustness-errors: '", part, "' must be METRES:DEGREES, for example 0.05:2");
    list.push_back(
        {numbers_from_text("robustness-errors", both[0], 1)[0], numbers_from_text("robustness-errors", both[1], 1)[0]});
    require(list.back().position >= 0 && list.back().orientation >= 0, "robustness-errors: '", part,
            "' must not be negative");
  }
  return list;
}

std::vector<std::string> RobustnessOptions::registration_list() const { return split(registrations, ','); }

ReconstructOptions RobustnessOptions::run_options(const Deviation& error, const std::string& registration) const {
  ReconstructOptions options;
  options.utility = utility;
  options.depth_noise = depth_noise;
  options.positioning_error = Vec3::Constant(error.position);
  options.orientation_error = Vec3::Constant(error.orientation);
  options.registration = registration;
  return options;
}

std::vector<std::shared_ptr<const SweepObject>> robustness_objects(const std::optional<std::filesystem::path>& folder) {
  std::vector<std::shared_ptr<const SweepObject>> objects;
  const auto has = [&](const PublishedObject& published) {
    return std::filesystem::exists(*folder / concat(published.name, ".ply"));
  };
  if (!folder || std::any_of(published_objects.begin(), published_objects.end(), has)) {
    for (const PaperObject& object : paper_objects(folder)) objects.push_back(object.object);
    return objects;
  }
  std::vector<std::filesystem::path> meshes;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    if (entry.path().extension() == ".ply") meshes.push_back(entry.path());
  }
  std::sort(meshes.begin(), meshes.end());
  require(!meshes.empty(), "objects = ", folder->string(), ": has no mesh NAME.ply");
  for (const std::filesystem::path& mesh : meshes) {
    objects.push_back(
        std::make_shared<SweepObject>(mesh.stem().string(), read_mesh(mesh), object_size, mesh.filename().string()));
  }
  return objects;
}

}  // namespace vantage
