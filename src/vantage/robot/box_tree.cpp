#include "vantage/robot/box_tree.hpp"

#include <algorithm>
#include <limits>

namespace vantage {
namespace {

constexpr std::size_t boxes_per_leaf = 4;

}  // namespace

BoxTree::BoxTree(std::vector<Box3> boxes) : boxes_(std::move(boxes)) {
  if (!boxes_.empty()) build(0, boxes_.size());
}

void BoxTree::build(std::size_t begin, std::size_t end) {
  const std::size_t self = nodes_.size();
  nodes_.push_back({{}, begin, end, 0});
  for (std::size_t i = begin; i < end; ++i) nodes_[self].bounds.extend(boxes_[i]);
  if (end - begin <= boxes_per_leaf) return;
  Eigen::Index axis = 0;
  nodes_[self].bounds.sizes().maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) { return boxes_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const Box3& a, const Box3& b) { return a.center()[axis] < b.center()[axis]; });
  build(begin, middle);
  nodes_[self].right = nodes_.size();
  build(middle, end);
}

double BoxTree::nearest(std::size_t node, const Vec3& point, double best) const {
  const Node& here = nodes_[node];
  if (here.bounds.squaredExteriorDistance(point) >= best) return best;
  if (here.right == 0) {
    for (std::size_t i = here.begin; i < here.end; ++i) best = std::min(best, boxes_[i].squaredExteriorDistance(point));
    return best;
  }
  std::size_t first = node + 1;
  std::size_t second = here.right;
  if (nodes_[second].bounds.squaredExteriorDistance(point) < nodes_[first].bounds.squaredExteriorDistance(point)) {
    std::swap(first, second);
  }
  return nearest(second, point, nearest(first, point, best));
}

double BoxTree::distance(const Vec3& point) const {
  if (nodes_.empty()) return std::numeric_limits<double>::infinity();
  return std::sqrt(nearest(0, point, std::numeric_limits<double>::infinity()));
}

}  // namespace vantage
