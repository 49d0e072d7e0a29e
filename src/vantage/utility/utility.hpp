#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "vantage/robot/travel.hpp"
#include "vantage/utility/factors.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage {

/// A view that a utility is asked about.
struct ViewToJudge {
  int candidate = -1;
  View view = {};
  Resolution resolution = {};  // of the rays it was seen with
  Resolution ideal = {};       // eq. 14: neighbouring rays are one voxel apart at the center of the candidates
  double travel = 0;           // from the current view: x of eq. 10, in [0, 1]
  Visibility seen = {};
  Factors factors = {};
};

/// The moment at which a view is to be chosen: all that a utility may look at.
struct Choice {
  const VoxelMap& map;
  const VisibilityEvaluator& visibility;  // of the map
  const RangeCamera& camera;
  View current;
  std::span<const View> scanned;       // views from which scans were merged, in their order; what the planner knows
  std::uint64_t seed = 1;              // for utilities that draw
  std::span<const ViewToJudge> views;  // feasible ones
  /// Where there is one, a utility may give `not_judged` to views that it begins with after it; the best ones are
  /// expected first in `views`.
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  /// Views whose scans could not be merged since the last one that could: what is known may be too little to go by.
  int refused = 0;
  Travel travel = {};  // how moves between the views are counted
};

/// The score of a view that there was no time for.
inline constexpr double not_judged = -std::numeric_limits<double>::infinity();

/// How good a view is, from what it would see: the fast kind, called once per view with numbers alone.
using CountUtility = std::function<double(const Visibility&, const Factors&)>;
/// How good each of the views is, in the order of `choice.views`: for utilities that look at voxels, rays (see
/// ray_utility.hpp) or all views at once. Higher is better; 0 or less: not worth a scan.
using SetUtility = std::function<std::vector<double>(const Choice&)>;

/// A view of a tour over the rest of the scan.
struct TourStop {
  int candidate = -1;
  double seconds = 0;  // from now to the end of its scan
  double covered = 0;  // share of the expected surface that is known then
};

/// A utility with what it needs.
struct Utility {
  std::variant<CountUtility, SetUtility> score;
  bool needs_all_views = false;      // compares views: is asked once per plan, about all views there is time for
  bool skips_scanned_views = false;  // never chooses a view twice
  /// The rest of the scan, where it plans that: the view of the highest score first.
  std::function<std::vector<TourStop>(const Choice&)> tour = {};

  [[nodiscard]] bool counts_only() const { return std::holds_alternative<CountUtility>(score); }
};

/// A utility that looks at one view's visible voxels (unique, scene indices, x fastest) at a time. `judge(choice,
/// view, voxels)` is called from several threads.
using VoxelUtility = std::function<double(const Choice&, const ViewToJudge&, std::span<const Index3>)>;
[[nodiscard]] Utility voxel_utility(VoxelUtility judge);

/// Scores of all views. Throws Error where the utility returns another number of scores or one that is not finite.
[[nodiscard]] std::vector<double> judge(const Utility& utility, const Choice& choice);

}  // namespace vantage
