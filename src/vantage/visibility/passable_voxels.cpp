#include "vantage/visibility/passable_voxels.hpp"

#include <algorithm>
#include <bit>

namespace vantage {
namespace {

/// The rows of a map's planes that one row of voxels needs.
class PassableRow {
 public:
  PassableRow(const VoxelMap& map, const BitPlane& passable, const std::array<int, 3>& side, int y, int z)
      : map_(map), layout_(map.layout()), side_(side), y_(y), z_(z), at_(layout_.row(y, z)), passable_(passable) {
    before_y_ = row_before(y - side[1], z);
    before_z_ = row_before(y, z - side[2]);
  }

  void append(std::vector<std::uint32_t>& voxels) const {
    const int words = layout_.words_per_row;
    for (int i = 0; i < words; ++i) {
      const int w = side_[0] > 0 ? i : words - 1 - i;
      const std::uint64_t full = ~map_.empty().words[word(w)] & layout_.row_mask(w);
      if (full != 0) pack(w, full & facing(w), voxels);
    }
  }

 private:
  [[nodiscard]] std::size_t word(int w) const { return at_ + static_cast<std::size_t>(w); }
  [[nodiscard]] const std::uint64_t* row_before(int y, int z) const {
    const bool is_inside = y >= 0 && y < layout_.size.y() && z >= 0 && z < layout_.size.z();
    return is_inside ? passable_.words.data() + layout_.row(y, z) : nullptr;
  }
  /// What lies outside of the enclosure is empty.
  [[nodiscard]] std::uint64_t passable(int w) const {
    if (w < 0 || w >= layout_.words_per_row) return ~std::uint64_t{0};
    return passable_.words[word(w)] | ~layout_.row_mask(w);
  }
  [[nodiscard]] std::uint64_t facing(int w) const {
    constexpr std::uint64_t all = ~std::uint64_t{0};
    const std::uint64_t along_x =
        side_[0] > 0 ? passable(w) << 1U | passable(w - 1) >> 63U : passable(w) >> 1U | passable(w + 1) << 63U;
    return along_x | (before_y_ ? before_y_[w] : all) | (before_z_ ? before_z_[w] : all);
  }
  void pack(int w, std::uint64_t bits, std::vector<std::uint32_t>& voxels) const {
    const std::uint64_t hidden = map_.hidden().words[word(w)];
    const std::uint64_t marked = map_.occupied().words[word(w)] | map_.occplane().words[word(w)];
    const std::uint32_t place = static_cast<std::uint32_t>(64 * w) | static_cast<std::uint32_t>(y_) << 10U |
                                static_cast<std::uint32_t>(z_) << 20U;
    while (bits != 0) {
      const int bit = side_[0] > 0 ? std::countr_zero(bits) : 63 - std::countl_zero(bits);
      bits &= ~(std::uint64_t{1} << bit);
      voxels.push_back((place + static_cast<std::uint32_t>(bit)) |
                       static_cast<std::uint32_t>((hidden >> bit & 1U) << 31U | (marked >> bit & 1U) << 30U));
    }
  }

  const VoxelMap& map_;
  const BitLayout& layout_;
  const std::array<int, 3>& side_;
  int y_, z_;
  std::size_t at_;
  const BitPlane& passable_;
  const std::uint64_t *before_y_ = nullptr, *before_z_ = nullptr;
};

/// ORs to the words of some rows those of their neighbours along x on the side of the camera. What lies outside of the
/// enclosure is empty.
void or_along_x(const std::uint64_t* rows, std::size_t count, const BitLayout& layout, int side, std::uint64_t* to) {
  const auto words = static_cast<std::size_t>(layout.words_per_row);
  const std::uint64_t beyond = ~layout.row_mask(layout.words_per_row - 1);
  constexpr std::uint64_t last_bit = std::uint64_t{1} << 63U;
  if (words == 1 && side > 0) {
    for (std::size_t k = 0; k < count; ++k) to[k] |= rows[k] << 1U | 1U;
  } else if (words == 1) {
    for (std::size_t k = 0; k < count; ++k) to[k] |= (rows[k] | beyond) >> 1U | last_bit;
  } else {
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t w = k % words;
      if (side > 0) {
        to[k] |= rows[k] << 1U | (w == 0 ? 1U : rows[k - 1] >> 63U);
      } else if (w + 1 == words) {
        to[k] |= (rows[k] | beyond) >> 1U | last_bit;
      } else {
        to[k] |= rows[k] >> 1U | rows[k + 1] << 63U;
      }
    }
  }
}

/// Sets the bits of the region's voxels that have a neighbour in `passable` on a side that faces the camera, and some
/// of voxels that are no candidates. In long loops over words, which compilers vectorise.
void mark_facing(const BitPlane& passable, const BitLayout& layout, const Region& region, BitPlane& facing) {
  constexpr std::uint64_t all = ~std::uint64_t{0};
  const auto words = static_cast<std::size_t>(layout.words_per_row);
  const int rows = region.box.max.y() - region.box.min.y() + 1;
  const auto count = static_cast<std::size_t>(rows) * words;
  for (int z = region.box.min.z(); z <= region.box.max.z(); ++z) {
    const std::size_t first = layout.row(region.box.min.y(), z);
    const std::uint64_t* const here = passable.words.data() + first;
    std::uint64_t* const to = facing.words.data() + first;
    const int z_before = z - region.side[2];
    if (z_before < 0 || z_before >= layout.size.z()) {
      std::fill_n(to, count, all);
      continue;
    }
    const std::uint64_t* const before_z = passable.words.data() + layout.row(region.box.min.y(), z_before);
    // The row at the enclosure's border has emptiness before it.
    const bool begins_at_border = region.side[1] > 0 && region.box.min.y() == 0;
    const bool ends_at_border = region.side[1] < 0 && region.box.max.y() == layout.size.y() - 1;
    const std::size_t from = begins_at_border ? words : 0;
    const std::size_t end = ends_at_border ? count - words : count;
    std::fill_n(to, from, all);
    if (region.side[1] > 0) {
      for (std::size_t k = from; k < end; ++k) to[k] = before_z[k] | here[k - words];
    } else {
      for (std::size_t k = from; k < end; ++k) to[k] = before_z[k] | here[k + words];
    }
    std::fill_n(to + end, count - end, all);
    or_along_x(here, count, layout, region.side[0], to);
  }
}

}  // namespace

void PassableVoxels::collect(const BitPlane& passable, const Region& region, const BatchRegion& batch, BitPlane& facing,
                             std::vector<std::uint32_t>& voxels) const {
  const BitLayout& layout = map_->layout();
  facing.words.resize(layout.words());
  mark_facing(passable, layout, region, facing);
  const std::vector<std::uint32_t>& octant = octants_[number(region.side)];
  constexpr std::size_t room = 16;
  const std::size_t before = voxels.size();
  voxels.resize(before + octant.size() + room);
  std::uint32_t* const first = voxels.data() + before;
  const std::size_t inside = select_(batch, octant.data(), octant.size(), first);
  const auto rows_per_layer = static_cast<std::uint32_t>(layout.size.y());
  const auto words_per_row = static_cast<std::uint32_t>(layout.words_per_row);
  const std::uint64_t* const words = facing.words.data();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < inside; ++i) {  // without branches, which nobody could foresee
    const std::uint32_t voxel = first[i];
    const std::uint32_t row = (voxel >> 20U & 1023U) * rows_per_layer + (voxel >> 10U & 1023U);
    const std::uint32_t x = voxel & 1023U;
    first[kept] = voxel;
    kept += words[row * words_per_row + (x >> 6U)] >> (x & 63U) & 1U;
  }
  voxels.resize(before + kept);
}

PassableVoxels::PassableVoxels(const VoxelMap& map, SelectInside select) : map_(&map), select_(select) {
  BitPlane passable = map.empty();
  for (std::size_t i = 0; i < passable.words.size(); ++i) passable.words[i] |= map.occupied().words[i];
  const Index3& size = map.layout().size;
  for (const int sz : {-1, 1}) {
    for (const int sy : {-1, 1}) {
      for (const int sx : {-1, 1}) {
        const std::array<int, 3> side{sx, sy, sz};
        std::vector<std::uint32_t>& voxels = octants_[number(side)];
        for (int i = 0; i < size.z(); ++i) {
          for (int j = 0; j < size.y(); ++j) {
            const int z = sz > 0 ? i : size.z() - 1 - i;
            const int y = sy > 0 ? j : size.y() - 1 - j;
            PassableRow(map, passable, side, y, z).append(voxels);
          }
        }
      }
    }
  }
}

}  // namespace vantage
