#include "vantage/visibility/passable_voxels.hpp"

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

}  // namespace

PassableVoxels::PassableVoxels(const VoxelMap& map) {
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
