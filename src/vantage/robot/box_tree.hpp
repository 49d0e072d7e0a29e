#pragma once

#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// Tells how far a point is from the nearest of many boxes.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box3> boxes);

  /// Metres to the nearest box, 0 inside of one; infinite where there is none.
  [[nodiscard]] double distance(const Vec3& point) const;
  /// Around all boxes; empty where there are none.
  [[nodiscard]] Box3 bounds() const { return nodes_.empty() ? Box3() : nodes_.front().bounds; }

 private:
  struct Node {
    Box3 bounds;
    std::size_t begin, end;  // of its boxes
    std::size_t right;       // second child, the first comes next; 0: a leaf
  };
  void build(std::size_t begin, std::size_t end);
  [[nodiscard]] double nearest(std::size_t node, const Vec3& point, double best) const;

  std::vector<Box3> boxes_;
  std::vector<Node> nodes_;
};

}  // namespace vantage
