#include "vantage/registration/oriented_index.hpp"

#include <algorithm>
#include <nanoflann.hpp>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using Coordinates = Eigen::Matrix<float, 6, 1>;

/// What nanoflann asks of a data set; the names are its own.
struct OrientedSet {
  std::vector<Coordinates> rows;

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return rows.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return rows[index][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using OrientedTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, OrientedSet>, OrientedSet, 6>;

Coordinates coordinates(const SurfaceSample& sample, double length) {
  Coordinates row;
  row << sample.point.cast<float>(), (length * sample.normal).cast<float>();
  return row;
}

std::vector<Coordinates> all_coordinates(std::span<const SurfaceSample> samples, std::size_t stride, double length) {
  std::vector<Coordinates> rows;
  rows.reserve(samples.size() / stride + 1);
  for (std::size_t i = 0; i < samples.size(); i += stride) rows.push_back(coordinates(samples[i], length));
  return rows;
}

}  // namespace

struct OrientedIndex::Tree {
  std::span<const SurfaceSample> samples;
  std::size_t stride;
  double length;
  OrientedSet set;
  OrientedTree tree;

  Tree(std::span<const SurfaceSample> all, std::size_t every, double normal_length)
      : samples(all),
        stride(every),
        length(normal_length),
        set{all_coordinates(all, every, normal_length)},
        tree(6, set, nanoflann::KDTreeSingleIndexAdaptorParams(8)) {}
};

OrientedIndex::OrientedIndex(std::span<const SurfaceSample> samples, std::size_t most, double length) {
  require(!samples.empty() && most > 0, "oriented index: there are no samples");
  tree_ = std::make_unique<Tree>(samples, (samples.size() + most - 1) / most, length);
}

OrientedIndex::~OrientedIndex() = default;

std::size_t OrientedIndex::stride() const { return tree_->stride; }

const SurfaceSample* OrientedIndex::nearest(const SurfaceSample& query) const {
  std::size_t index = 0;
  float squared = 0;
  nanoflann::KNNResultSet<float> result(1);
  result.init(&index, &squared);
  const Coordinates row = coordinates(query, tree_->length);
  tree_->tree.findNeighbors(result, row.data(), nanoflann::SearchParams());
  const SurfaceSample& found = tree_->samples[index * tree_->stride];
  return found.normal.dot(query.normal) >= 0.5 ? &found : nullptr;
}

}  // namespace vantage
