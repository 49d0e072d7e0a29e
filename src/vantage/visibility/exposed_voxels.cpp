#include "vantage/visibility/exposed_voxels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vantage {
namespace {

constexpr std::size_t largest_octant = std::size_t{1} << 20U;  // voxels: 4 MB each

/// Bits first..last of word w of a row; none where first > last.
std::uint64_t bits_between(int first, int last, int w) {
  const int from = std::max(first - 64 * w, 0);
  const int to = std::min(last - 64 * w, 63);
  return from > to ? 0 : (~std::uint64_t{0} << from) & (~std::uint64_t{0} >> (63 - to));
}

/// The rows of a map's bit planes. What lies outside of the enclosure is empty.
class Rows {
 public:
  explicit Rows(const VoxelMap& map) : map_(map), layout_(map.layout()) {}

  [[nodiscard]] std::uint64_t empty(int y, int z, int w) const {
    const bool outside =
        y < 0 || y >= layout_.size.y() || z < 0 || z >= layout_.size.z() || w < 0 || w >= layout_.words_per_row;
    return outside ? ~std::uint64_t{0} : map_.empty().words[word(y, z, w)] | ~layout_.row_mask(w);
  }
  /// Voxels whose neighbour towards the camera is empty, on at least one axis; empty ones among them.
  [[nodiscard]] std::uint64_t facing(const Region& region, int y, int z, int w) const {
    std::uint64_t facing = 0;
    if (region.side[0] > 0) facing |= empty(y, z, w) << 1U | empty(y, z, w - 1) >> 63U;
    if (region.side[0] < 0) facing |= empty(y, z, w) >> 1U | empty(y, z, w + 1) << 63U;
    if (region.side[1] != 0) facing |= empty(y - region.side[1], z, w);
    if (region.side[2] != 0) facing |= empty(y, z - region.side[2], w);
    return facing;
  }
  [[nodiscard]] std::uint32_t pack(int y, int z, int w, int bit) const {
    const std::size_t at = word(y, z, w);
    const std::uint64_t is_hidden = map_.hidden().words[at] >> bit & 1U;
    const std::uint64_t is_marked = (map_.occupied().words[at] | map_.occplane().words[at]) >> bit & 1U;
    return static_cast<std::uint32_t>(64 * w + bit) | static_cast<std::uint32_t>(y) << 10U |
           static_cast<std::uint32_t>(z) << 20U | static_cast<std::uint32_t>(is_hidden << 31U | is_marked << 30U);
  }

 private:
  [[nodiscard]] std::size_t word(int y, int z, int w) const { return layout_.row(y, z) + static_cast<std::size_t>(w); }

  const VoxelMap& map_;
  const BitLayout& layout_;
};

/// Indices min..max, ascending or descending so that they step away from the camera.
struct Steps {
  int first, end, step;
  Steps(int min, int max, int side)
      : first(side < 0 ? max : min), end(side < 0 ? min - 1 : max + 1), step(side < 0 ? -1 : 1) {}
};

std::size_t octant_number(const std::array<int, 3>& side) {
  return (side[0] > 0 ? 1U : 0U) + (side[1] > 0 ? 2U : 0U) + (side[2] > 0 ? 4U : 0U);
}

}  // namespace

std::vector<Region> regions_front_to_back(const Index3& size, const Index3& camera_cell) {
  std::vector<Region> regions;
  for (int slabs = 3; slabs >= 0; --slabs) {
    for (int code = 0; code < 27; ++code) {
      const std::array<int, 3> side{code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
      if (std::count(side.begin(), side.end(), 0) != slabs) continue;
      Region region;
      region.side = side;
      for (int a = 0; a < 3; ++a) {
        const int s = region.side_of(a);
        region.box.min[a] = std::max(0, s < 0 ? 0 : camera_cell[a] + s);
        region.box.max[a] = std::min(size[a] - 1, s > 0 ? size[a] - 1 : camera_cell[a] + s);
      }
      if ((region.box.min.array() <= region.box.max.array()).all()) regions.push_back(region);
    }
  }
  return regions;
}

std::array<int, 2> FirstVoxels::in_row(int y, int z) const {
  if (y < box.min.y() || y > box.max.y() || z < box.min.z() || z > box.max.z()) return {0, -1};
  const double at_zero = offset + gradient.y() * y + gradient.z() * z;
  if (gradient.x() == 0) {
    return std::abs(at_zero) <= limit ? std::array{box.min.x(), box.max.x()} : std::array{0, -1};
  }
  const double a = (-limit - at_zero) / gradient.x();
  const double b = (limit - at_zero) / gradient.x();
  const auto clamped = [&](double x) { return std::clamp(x, box.min.x() - 1.0, box.max.x() + 1.0); };
  return {std::max(box.min.x(), static_cast<int>(std::floor(clamped(std::min(a, b))))),
          std::min(box.max.x(), static_cast<int>(std::ceil(clamped(std::max(a, b)))))};
}

ExposedVoxels::ExposedVoxels(const VoxelMap& map) : map_(&map) {
  const IndexBox all{Index3::Zero(), map.layout().size - Index3::Ones()};
  has_octants_ = true;
  for (const int z : {-1, 1}) {
    for (const int y : {-1, 1}) {
      for (const int x : {-1, 1}) {
        const Region region{all, {x, y, z}};
        std::vector<std::uint32_t>& octant = octants_[octant_number(region.side)];
        if (has_octants_) collect(region, nullptr, octant);
        if (octant.size() > largest_octant) has_octants_ = false;
      }
    }
  }
  if (!has_octants_) octants_ = {};
}

const std::vector<std::uint32_t>* ExposedVoxels::octant(const std::array<int, 3>& side) const {
  return has_octants_ ? &octants_[octant_number(side)] : nullptr;
}

void ExposedVoxels::collect(const Region& region, const FirstVoxels* first, std::vector<std::uint32_t>& voxels) const {
  const Rows rows(*map_);
  const BitLayout& layout = map_->layout();
  const Steps zs(region.box.min.z(), region.box.max.z(), region.side[2]);
  const Steps ys(region.box.min.y(), region.box.max.y(), region.side[1]);
  const Steps ws(region.box.min.x() / 64, region.box.max.x() / 64, region.side[0]);
  for (int z = zs.first; z != zs.end; z += zs.step) {
    for (int y = ys.first; y != ys.end; y += ys.step) {
      const std::array<int, 2> first_in_row = first ? first->in_row(y, z) : std::array{0, -1};
      for (int w = ws.first; w != ws.end; w += ws.step) {
        const std::uint64_t full =
            ~rows.empty(y, z, w) & layout.row_mask(w) & bits_between(region.box.min.x(), region.box.max.x(), w);
        if (full == 0) continue;
        std::uint64_t found = full & (rows.facing(region, y, z, w) | bits_between(first_in_row[0], first_in_row[1], w));
        while (found != 0) {
          const int bit = region.side[0] < 0 ? 63 - std::countl_zero(found) : std::countr_zero(found);
          found &= ~(std::uint64_t{1} << bit);
          voxels.push_back(rows.pack(y, z, w, bit));
        }
      }
    }
  }
}

}  // namespace vantage
