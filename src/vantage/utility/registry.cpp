#include "vantage/utility/registry.hpp"

#include "vantage/core/error.hpp"
#include "vantage/utility/edge_proximity.hpp"
#include "vantage/utility/field_utilities.hpp"
#include "vantage/utility/gain.hpp"
#include "vantage/utility/ray_information.hpp"
#include "vantage/utility/ray_utility.hpp"
#include "vantage/utility/tour.hpp"

namespace vantage {
namespace {

Utility combined() {
  return {.score = CountUtility([](const Visibility&, const Factors& f) { return combined_utility(f); })};
}

Utility gua() {
  return {.score = CountUtility([](const Visibility&, const Factors& f) { return gua_utility(f); })};
}

template <class Sum>
Utility along_rays() {
  Utility utility = ray_utility<Sum>();
  utility.skips_scanned_views = true;
  return utility;
}

constexpr UtilityEntry entries[] = {
    {"combined", "the paper's utility, eq. 13", combined},
    {"gua", "greatest unknown area, eq. 21", gua},
    {"gain", "worth of the unknown that a view and the best one after it would meet", [] { return gain_utility(); }},
    {"tour", "the first view of the fastest tour over the rest of the scan", [] { return tour_utility(); }},
    {"oa", "occlusion-aware information (Delmerico et al.)", along_rays<OcclusionAware>},
    {"uv", "unobserved voxels (Delmerico et al.)", along_rays<UnobservedVoxel>},
    {"rsv", "rear side voxels (Delmerico et al.)", along_rays<RearSideVoxel>},
    {"rse", "rear side entropy (Delmerico et al.)", along_rays<RearSideEntropy>},
    {"pc", "proximity count (Delmerico et al.)", along_rays<ProximityCount>},
    {"ae", "average entropy (Delmerico et al.)", along_rays<AverageEntropy>},
    {"kriegel", "information gain where a fifth overlaps (Kriegel et al.)", along_rays<KriegelGain>},
    {"massios-fisher", "occplanes and poor quality (Massios and Fisher)", massios_fisher_utility},
    {"sanchiz-fisher", "overlap plus unknown area (Sanchiz and Fisher)", sanchiz_fisher_utility},
    {"blaer-allen", "boundary voxels (Blaer and Allen)", blaer_allen_utility},
    {"apora", "unknown voxels near the edges of the known surface (APORA)", along_rays<AporaSum>},
    {"random", "any view", random_utility},
    {"uniform", "the view farthest from all before", uniform_utility},
};

}  // namespace

std::span<const UtilityEntry> known_utilities() { return entries; }

std::vector<std::string> utility_names() {
  std::vector<std::string> names;
  for (const UtilityEntry& entry : known_utilities()) names.emplace_back(entry.name);
  return names;
}

Utility utility_by_name(const std::string& name) {
  std::string known;
  for (const UtilityEntry& entry : known_utilities()) {
    if (name == entry.name) return entry.make();
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw InputError(concat("utility '", name, "' is unknown; must be one of: ", known));
}

}  // namespace vantage
