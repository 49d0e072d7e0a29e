#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// A point of an index and how far it lies from the query.
struct Neighbor {
  std::size_t index = 0;
  double squared_distance = 0;  // m^2
};

/// Nearest-neighbour queries over a fixed set of points (a kd-tree). Queries may run on several threads at once.
class PointIndex {
 public:
  explicit PointIndex(std::vector<Vec3> points);
  ~PointIndex();
  PointIndex(PointIndex&&) noexcept;
  PointIndex& operator=(PointIndex&&) noexcept;

  [[nodiscard]] std::span<const Vec3> points() const;
  /// The nearest point, or nothing where the index is empty.
  [[nodiscard]] std::optional<Neighbor> nearest(const Vec3& query) const;
  /// Up to `count` nearest points, nearest first.
  [[nodiscard]] std::vector<Neighbor> nearest(const Vec3& query, std::size_t count) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// The typical distance between neighbouring points of a sampled surface, metres: the median distance to the fourth
/// nearest neighbour (on a square grid the grid's pitch). Throws InputError for fewer than 5 points.
[[nodiscard]] double point_spacing(const PointIndex& index);

}  // namespace vantage
