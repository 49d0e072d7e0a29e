#include "vantage/robot/solid_boxes.hpp"

namespace vantage {
namespace {

/// The enclosure's voxels that are solid and not yet in a box. Indices are local to the enclosure.
class Remaining {
 public:
  explicit Remaining(const VoxelMap& map) : size_(map.enclosure().size()) {
    solid_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                  static_cast<std::size_t>(size_.z()));
    const Index3 origin = map.enclosure().min;
    for_all({Index3::Zero(), size_ - Index3::Ones()},
            [&](const Index3& v) { solid_[slot(v)] = map.label(origin + v) != Label::empty; });
  }

  [[nodiscard]] const Index3& size() const { return size_; }
  [[nodiscard]] bool all_solid(const IndexBox& box) const {
    bool all = true;
    for_all(box, [&](const Index3& v) { all = all && solid_[slot(v)]; });
    return all;
  }
  void take(const IndexBox& box) {
    for_all(box, [&](const Index3& v) { solid_[slot(v)] = false; });
  }
  template <class Visit>
  static void for_all(const IndexBox& box, const Visit& visit) {
    for (int z = box.min.z(); z <= box.max.z(); ++z) {
      for (int y = box.min.y(); y <= box.max.y(); ++y) {
        for (int x = box.min.x(); x <= box.max.x(); ++x) visit(Index3(x, y, z));
      }
    }
  }
  [[nodiscard]] bool is_solid(const Index3& v) const { return solid_[slot(v)]; }

 private:
  [[nodiscard]] std::size_t slot(const Index3& v) const {
    return (static_cast<std::size_t>(v.z()) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(v.y())) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(v.x());
  }

  Index3 size_;
  std::vector<bool> solid_;
};

/// The box grown along one axis as long as the next layer is solid.
IndexBox grown(const Remaining& remaining, IndexBox box, int axis) {
  while (box.max[axis] + 1 < remaining.size()[axis]) {
    IndexBox next = box;
    next.min[axis] = next.max[axis] = box.max[axis] + 1;
    if (!remaining.all_solid(next)) break;
    box.max[axis] = next.max[axis];
  }
  return box;
}

}  // namespace

std::vector<Box3> solid_boxes(const VoxelMap& map) {
  std::vector<Box3> boxes;
  Remaining remaining(map);
  const Index3 origin = map.enclosure().min;
  Remaining::for_all({Index3::Zero(), remaining.size() - Index3::Ones()}, [&](const Index3& voxel) {
    if (!remaining.is_solid(voxel)) return;
    IndexBox box{voxel, voxel};
    for (int axis = 0; axis < 3; ++axis) box = grown(remaining, box, axis);
    remaining.take(box);
    boxes.push_back(map.grid().box({origin + box.min, origin + box.max}));
  });
  return boxes;
}

}  // namespace vantage
