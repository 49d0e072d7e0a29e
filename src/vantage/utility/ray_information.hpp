#pragma once

#include <array>

#include "vantage/utility/information.hpp"
#include "vantage/utility/ray_utility.hpp"

// The volumetric information of Delmerico, Isler, Sabzevari and Scaramuzza ("A comparison of volumetric information
// gain metrics for active 3D object reconstruction", 2018) and of Kriegel, Rink, Bodenmueller and Suppa (2015), each as
// a sum over a view's rays and their voxels up to the first occupied one.
namespace vantage {

/// Entropies by label, and 1 - p, looked up instead of computed per voxel.
struct InformationTable {
  std::array<double, 5> entropy{}, transparency{};

  explicit InformationTable(const OccupancyProbabilities& probabilities = {});
  explicit InformationTable(const Choice&) : InformationTable(OccupancyProbabilities{}) {}
  [[nodiscard]] double entropy_of(Label label) const { return entropy[static_cast<std::size_t>(label)]; }
  [[nodiscard]] double transparency_of(Label label) const { return transparency[static_cast<std::size_t>(label)]; }
};

/// What all of them have.
struct InformationSum {
  using Shared = InformationTable;

  InformationSum(const Shared& shared, const ViewToJudge&) : table(shared) {}
  [[nodiscard]] double value() const { return sum; }

  const InformationTable& table;
  double sum = 0;
};

/// Occlusion-aware information: P_v H, with P_v(n) = prod over i < n of (1 - p_i), that the voxel can be seen.
struct OcclusionAware : InformationSum {
  using InformationSum::InformationSum;
  void add(RayVoxels voxels);
};

/// The same for unknown voxels only.
struct UnobservedVoxel : InformationSum {
  using InformationSum::InformationSum;
  void add(RayVoxels voxels);
};

/// Rays whose occupied voxel directly follows an unknown one: they look at the back of the surface.
struct RearSideVoxel : InformationSum {
  using InformationSum::InformationSum;
  void add(RayVoxels voxels);
};

/// P_v H over the unknown voxels directly before such an occupied one.
struct RearSideEntropy : InformationSum {
  using InformationSum::InformationSum;
  void add(RayVoxels voxels);
};

/// H per voxel over the rays that end at an occupied voxel.
struct AverageEntropy : InformationSum {
  using InformationSum::InformationSum;
  void add(RayVoxels voxels);
  [[nodiscard]] double value() const { return voxels_counted > 0 ? sum / static_cast<double>(voxels_counted) : 0; }
  std::int64_t voxels_counted = 0;
};

/// Kriegel's information gain: H of the unknown voxels before the first hit, where a fifth of what is seen is known.
struct KriegelGain : InformationSum {
  static constexpr double min_overlap = 0.2;

  KriegelGain(const Shared& shared, const ViewToJudge& view)
      : InformationSum(shared, view), overlaps(view.factors.x_oc >= min_overlap) {}
  void add(RayVoxels voxels);
  [[nodiscard]] double value() const { return overlaps ? sum : 0; }
  bool overlaps;
};

/// How many cells an unknown voxel lies behind the surface, along the line of sight of the scan that put it nearest.
class CellsBehindSurface {
 public:
  static constexpr double reach = 0.6;  // metres: d_max

  explicit CellsBehindSurface(const Choice& choice);
  [[nodiscard]] double limit() const { return limit_; }  // d_max, in cells
  /// limit() where no scan sees a surface within that before the voxel.
  [[nodiscard]] double at(const Index3& scene_index) const;

 private:
  IndexBox enclosure_;
  double limit_;
  std::vector<std::uint16_t> cells_;
};

/// Proximity count: d_max - d over the unknown voxels, d as CellsBehindSurface says.
struct ProximityCount {
  using Shared = CellsBehindSurface;

  ProximityCount(const Shared& cells_behind, const ViewToJudge&) : cells(cells_behind) {}
  void add(RayVoxels voxels);
  [[nodiscard]] double value() const { return sum; }

  const CellsBehindSurface& cells;
  double sum = 0;
};

}  // namespace vantage
