#pragma once

#include <cstddef>
#include <vector>

#include "vantage/registration/surface_features.hpp"

namespace vantage {

/// Places of two surfaces that look alike and may be the same.
struct FeatureMatch {
  std::size_t fixed = 0, moving = 0;  // numbers of the places
  float likeness = 0;                 // 0..1
};

struct FeatureMatchOptions {
  std::size_t rivals = 5;   // each place must be among so many that are most like the other one
  std::size_t most = 1000;  // matches, the likest first

  void validate() const;
};

/// Mutual matches, the likest first.
[[nodiscard]] std::vector<FeatureMatch> feature_matches(const SurfaceFeatures& fixed, const SurfaceFeatures& moving,
                                                        const FeatureMatchOptions& options = {});

/// A pose on which matches agree.
struct PoseHypothesis {
  Pose fixed_from_moving = Pose::Identity();
  int support = 0;  // places of the moving surface whose match it explains
};

struct MatchConsensusOptions {
  double tolerance_in_cells = 1.5;    // distances between places that belong together may differ by this
  double tolerance_of_cosines = 0.3;  // likewise angles of normals to each other and to the line between the places
  std::size_t most = 64;              // hypotheses

  void validate() const;
};

/// Whether two matches can both be right: both surfaces have the places equally far from each other and the normals
/// equally turned.
[[nodiscard]] bool are_consistent(const SurfaceFeatures& fixed, const SurfaceFeatures& moving, const FeatureMatch& a,
                                  const FeatureMatch& b, const MatchConsensusOptions& options = {});

/// The poses on which most matches agree, the best first; two of them differ by more than three cells. Matches vote in
/// pairs that are consistent, weighed by how many others are consistent with both (second-order consistency: Chen,
/// Sun, Yang and Tao, CVPR 2022).
[[nodiscard]] std::vector<PoseHypothesis> pose_hypotheses(const SurfaceFeatures& fixed, const SurfaceFeatures& moving,
                                                          const std::vector<FeatureMatch>& matches,
                                                          const MatchConsensusOptions& options = {});

}  // namespace vantage
