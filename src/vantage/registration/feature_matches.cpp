#include "vantage/registration/feature_matches.hpp"

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

struct Candidate {
  float likeness = 0;
  std::size_t place = 0;
};

/// For each descriptor the `count` most alike of `among`, the likest first; of equals the earlier.
std::vector<std::vector<Candidate>> most_alike(const std::vector<SurfaceDescriptor>& descriptors,
                                               const std::vector<SurfaceDescriptor>& among, std::size_t count) {
  std::vector<std::vector<Candidate>> found(descriptors.size());
  parallel_for(descriptors.size(), [&](std::size_t i) {
    std::vector<Candidate>& best = found[i];
    best.reserve(count + 1);
    for (std::size_t j = 0; j < among.size(); ++j) {
      const float likeness = descriptors[i].dot(among[j]);
      if (best.size() == count && likeness <= best.back().likeness) continue;
      const auto place = std::upper_bound(best.begin(), best.end(), likeness,
                                          [](float value, const Candidate& other) { return value > other.likeness; });
      best.insert(place, {likeness, j});
      if (best.size() > count) best.pop_back();
    }
  });
  return found;
}

}  // namespace

void FeatureMatchOptions::validate() const {
  require(rivals >= 1, "feature matches: rivals = ", rivals, ": must be at least 1");
  require(most >= 3, "feature matches: most = ", most, ": must be at least 3");
}

std::vector<FeatureMatch> feature_matches(const SurfaceFeatures& fixed, const SurfaceFeatures& moving,
                                          const FeatureMatchOptions& options) {
  options.validate();
  const auto of_moving = most_alike(moving.descriptors, fixed.descriptors, options.rivals);
  const auto of_fixed = most_alike(fixed.descriptors, moving.descriptors, options.rivals);
  std::vector<FeatureMatch> matches;
  for (std::size_t i = 0; i < of_moving.size(); ++i) {
    for (const Candidate& candidate : of_moving[i]) {
      const auto& back = of_fixed[candidate.place];
      const bool is_mutual = std::any_of(back.begin(), back.end(), [&](const Candidate& b) { return b.place == i; });
      if (is_mutual) matches.push_back({candidate.place, i, candidate.likeness});
    }
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const FeatureMatch& a, const FeatureMatch& b) { return a.likeness > b.likeness; });
  if (matches.size() > options.most) matches.resize(options.most);
  return matches;
}

}  // namespace vantage
