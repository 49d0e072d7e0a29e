#include "vantage/utility/ray_utility.hpp"

namespace vantage {

LabelTable::LabelTable(const VoxelMap& map) : enclosure_(map.enclosure()), size_(map.enclosure().size()) {
  labels_.reserve(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                  static_cast<std::size_t>(size_.z()));
  for (int z = enclosure_.min.z(); z <= enclosure_.max.z(); ++z) {
    for (int y = enclosure_.min.y(); y <= enclosure_.max.y(); ++y) {
      for (int x = enclosure_.min.x(); x <= enclosure_.max.x(); ++x) labels_.push_back(map.label({x, y, z}));
    }
  }
}

Resolution ray_resolution(const ViewToJudge& view) {
  return {std::min(view.resolution.columns, view.ideal.columns), std::min(view.resolution.rows, view.ideal.rows)};
}

}  // namespace vantage
