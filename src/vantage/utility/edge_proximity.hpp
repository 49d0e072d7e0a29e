#pragma once

#include "vantage/utility/ray_information.hpp"

namespace vantage {

/// How likely an unknown voxel belongs to the object, by its distances d to the six nearest edge voxels: the product of
/// exp(-(alpha d)^2), alpha = 0.1 per voxel. Edge voxels are unknown ones with an empty and an occupied 26-neighbour:
/// there the known surface goes on.
class EdgeProximity {
 public:
  static constexpr double alpha = 0.1;  // per voxel length
  static constexpr std::size_t nearest = 6;

  explicit EdgeProximity(const Choice& choice);
  /// 0 for voxels that are not unknown, and where there are fewer than six edge voxels.
  [[nodiscard]] double at(const Index3& scene_index) const;
  /// Scene indices, x fastest.
  [[nodiscard]] const std::vector<Index3>& edges() const { return edges_; }

 private:
  IndexBox enclosure_;
  std::vector<Index3> edges_;
  std::vector<float> probability_;
};

/// APORA: p prod(1 - p) H over the unknown voxels of a ray, p as EdgeProximity says, the product over the unknown
/// voxels before.
struct AporaSum {
  using Shared = EdgeProximity;

  AporaSum(const Shared& edge_proximity, const ViewToJudge&) : edges(edge_proximity) {}
  void add(RayVoxels voxels);
  [[nodiscard]] double value() const { return sum; }

  const EdgeProximity& edges;
  double sum = 0;
};

}  // namespace vantage
