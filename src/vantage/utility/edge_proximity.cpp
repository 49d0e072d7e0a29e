#include "vantage/utility/edge_proximity.hpp"

#include <limits>
#include <numbers>

#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

bool is_edge(const VoxelMap& map, const Index3& voxel) {
  bool meets_empty = false;
  bool meets_occupied = false;
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const Label label = map.label(voxel + Index3(x, y, z));
        meets_empty |= label == Label::empty;
        meets_occupied |= label == Label::occupied;
      }
    }
  }
  return meets_empty && meets_occupied;
}

/// Sum of the least squared distances from a voxel to as many edges as count; edges are sorted by z.
std::int64_t sum_of_nearest(const std::vector<Index3>& edges, const Index3& voxel) {
  std::array<int, EdgeProximity::nearest> least{};
  least.fill(std::numeric_limits<int>::max());
  const auto middle =
      std::lower_bound(edges.begin(), edges.end(), voxel.z(), [](const Index3& edge, int z) { return edge.z() < z; });
  // True while farther edges in this direction may still count.
  const auto take = [&](const Index3& edge) {
    const Index3 offset = edge - voxel;
    if (offset.z() * offset.z() >= least.back()) return false;
    int distance = offset.squaredNorm();
    for (int& each : least) {
      if (distance < each) std::swap(distance, each);
    }
    return true;
  };
  for (auto up = middle; up != edges.end() && take(*up); ++up) {
  }
  for (auto down = middle; down != edges.begin() && take(*(down - 1)); --down) {
  }
  std::int64_t sum = 0;
  for (const int each : least) sum += each;
  return sum;
}

}  // namespace

EdgeProximity::EdgeProximity(const Choice& choice) : enclosure_(choice.map.enclosure()) {
  const VoxelMap& map = choice.map;
  const Index3 size = enclosure_.size();
  const LabelTable labels(map);
  const auto per_slice = static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y());
  const auto voxel_at = [&](std::size_t z, std::size_t i) {
    return Index3(enclosure_.min +
                  Index3(static_cast<int>(i) % size.x(), static_cast<int>(i) / size.x(), static_cast<int>(z)));
  };
  for (std::size_t z = 0; z < static_cast<std::size_t>(size.z()); ++z) {
    for (std::size_t i = 0; i < per_slice; ++i) {
      const Index3 voxel = voxel_at(z, i);
      if (is_unknown(labels.at(voxel)) && is_edge(map, voxel)) edges_.push_back(voxel);
    }
  }
  probability_.assign(per_slice * static_cast<std::size_t>(size.z()), 0.0F);
  if (edges_.size() < nearest) return;
  parallel_for(static_cast<std::size_t>(size.z()), [&](std::size_t z) {
    for (std::size_t i = 0; i < per_slice; ++i) {
      const Index3 voxel = voxel_at(z, i);
      if (!is_unknown(labels.at(voxel))) continue;
      const auto sum = static_cast<double>(sum_of_nearest(edges_, voxel));
      probability_[z * per_slice + i] = static_cast<float>(std::exp(-alpha * alpha * sum));
    }
  });
}

double EdgeProximity::at(const Index3& scene_index) const {
  const Index3 local = scene_index - enclosure_.min;
  const Index3 size = enclosure_.size();
  return static_cast<double>(probability_[(static_cast<std::size_t>(local.z()) * static_cast<std::size_t>(size.y()) +
                                           static_cast<std::size_t>(local.y())) *
                                              static_cast<std::size_t>(size.x()) +
                                          static_cast<std::size_t>(local.x())]);
}

void AporaSum::add(RayVoxels voxels) {
  double visible = 1;
  for (const RayVoxel& voxel : voxels) {
    if (!is_unknown(voxel.label)) continue;
    const double p = edges.at(voxel.index);
    sum += p * visible * std::numbers::ln2;  // H(0.5)
    visible *= 1 - p;
  }
}

}  // namespace vantage
