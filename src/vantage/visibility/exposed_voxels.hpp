#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/map/voxel_map.hpp"

namespace vantage {

/// A voxel of the enclosure and its label in one word: ten bits for each local index, two for the label.
struct PackedVoxel {
  static constexpr int max_side = 1024;
  enum Kind : std::uint32_t { unmarked = 0, occupied = 1, occluded = 2, occplane = 3 };

  std::uint32_t bits = 0;

  [[nodiscard]] Index3 index() const {
    return {static_cast<int>(bits & 1023U), static_cast<int>(bits >> 10U & 1023U),
            static_cast<int>(bits >> 20U & 1023U)};
  }
  /// Ascends with x fastest, then y, then z.
  [[nodiscard]] std::uint32_t place() const { return bits & 0x3fffffffU; }
  [[nodiscard]] Kind kind() const { return static_cast<Kind>(bits >> 30U); }
};

/// Voxels in one octant around the camera: `side` is the sign of (voxel - camera's cell) on each axis. The camera's own
/// slab of an axis belongs to the positive side.
struct Region {
  IndexBox box;  // local
  std::array<int, 3> side{1, 1, 1};

  [[nodiscard]] int side_of(int axis) const { return side[static_cast<std::size_t>(axis)]; }
};

/// The up to eight octants of a box around the camera's cell, front to back: positive sides first, because a ray leaves
/// the camera's slabs, which belong there, and never comes back.
[[nodiscard]] std::vector<Region> regions_front_to_back(const Index3& size, const Index3& camera_cell);

/// Voxels in which rays may begin without having come through an empty neighbour, as an interval of x for every row.
struct FirstVoxels {
  IndexBox box;   // local
  Vec3 gradient;  // |offset + gradient.index| <= limit
  double offset = 0, limit = 0;

  /// First and last x of a row; none where first > last.
  [[nodiscard]] std::array<int, 2> in_row(int y, int z) const;
};

/// The voxels of a map that rays can end in.
class ExposedVoxels {
 public:
  explicit ExposedVoxels(const VoxelMap& map);

  /// Appends (packed) the non-empty voxels of a region that have an empty neighbour on a side that faces the camera, in
  /// an order in which no voxel hides an earlier one; all non-empty voxels where `first` says so.
  void collect(const Region& region, const FirstVoxels* first, std::vector<std::uint32_t>& voxels) const;
  /// All exposed voxels of an octant that takes in the whole enclosure, collected once; nullptr where they would take
  /// too much memory.
  [[nodiscard]] const std::vector<std::uint32_t>* octant(const std::array<int, 3>& side) const;

 private:
  void collect_octants(int side_y, int side_z, std::vector<std::uint32_t>& descending,
                       std::vector<std::uint32_t>& ascending) const;

  const VoxelMap* map_;
  std::array<std::vector<std::uint32_t>, 8> octants_;
  bool has_octants_ = false;
};

}  // namespace vantage
