#include "vantage/registration/point_index.hpp"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

#include "vantage/core/error.hpp"
#include "vantage/core/order_statistics.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

/// What nanoflann asks of a data set; the names are its own.
struct PointSet {
  std::vector<Vec3> points;

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSet>, PointSet, 3>;
constexpr std::size_t leaf_size = 10;

}  // namespace

struct PointIndex::Tree {
  PointSet set;
  KdTree tree;

  explicit Tree(std::vector<Vec3> points)
      : set{std::move(points)}, tree(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size)) {}
};

PointIndex::PointIndex(std::vector<Vec3> points) : tree_(std::make_unique<Tree>(std::move(points))) {}
PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;
PointIndex& PointIndex::operator=(PointIndex&&) noexcept = default;

std::span<const Vec3> PointIndex::points() const { return tree_->set.points; }

std::optional<Neighbor> PointIndex::nearest(const Vec3& query) const {
  if (tree_->set.points.empty()) return std::nullopt;
  Neighbor found;
  nanoflann::KNNResultSet<double> result(1);
  result.init(&found.index, &found.squared_distance);
  tree_->tree.findNeighbors(result, query.data(), nanoflann::SearchParams());
  return found;
}

std::vector<Neighbor> PointIndex::nearest(const Vec3& query, std::size_t count) const {
  count = std::min(count, tree_->set.points.size());
  if (count == 0) return {};
  std::vector<std::size_t> indices(count);
  std::vector<double> squared(count);
  nanoflann::KNNResultSet<double> result(count);
  result.init(indices.data(), squared.data());
  tree_->tree.findNeighbors(result, query.data(), nanoflann::SearchParams());
  std::vector<Neighbor> found(count);
  for (std::size_t i = 0; i < count; ++i) found[i] = {indices[i], squared[i]};
  return found;
}

double point_spacing(const PointIndex& index) {
  const auto points = index.points();
  require(points.size() >= 5, "point spacing: ", points.size(), " points; must be at least 5");
  constexpr std::size_t samples = 2000;  // enough for a median within a few per cent
  const std::size_t step = std::max<std::size_t>(1, points.size() / samples);
  std::vector<double> squared((points.size() + step - 1) / step);
  parallel_for(squared.size(), [&](std::size_t i) {
    squared[i] = index.nearest(points[i * step], 5).back().squared_distance;  // the nearest is the point itself
  });
  return std::sqrt(upper_median(std::move(squared)));
}

}  // namespace vantage
