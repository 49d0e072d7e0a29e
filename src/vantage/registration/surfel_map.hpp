#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/registration/scan_surface.hpp"

namespace vantage {

/// A surface that grows scan by scan, as one mean sample per cell of a lattice and per side of a wall: its size depends
/// on the surface and not on the number of scans. Finding what lies near a point takes the same time however large the
/// surface is.
class SurfelMap {
 public:
  /// `cell`: metres. Throws InputError unless it is positive.
  explicit SurfelMap(double cell);

  /// Adds a sample in the map's frame: averaged into its cell's surfel that faces the same way, by weight.
  void add(const SurfaceSample& sample);

  /// Index of the surfel nearest to a point, of those that face the same way as `normal` (within 60 degrees) and lie in
  /// the 27 cells around it; -1 where there is none.
  [[nodiscard]] int nearest(const Vec3& point, const Vec3& normal) const;

  [[nodiscard]] std::span<const SurfaceSample> surfels() const { return surfels_; }
  [[nodiscard]] double cell() const { return cell_; }

 private:
  static constexpr double least_cosine = 0.5;
  static constexpr int most_sides = 6;  // per cell

  struct Slot {
    std::uint64_t key = 0;  // 0: free
    int first = -1;
  };
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const;
  void grow();

  double cell_;
  std::vector<SurfaceSample> surfels_;
  std::vector<Vec3> normal_sums_;
  std::vector<double> weights_;
  std::vector<int> next_;  // another side in the same cell, or -1
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

}  // namespace vantage
