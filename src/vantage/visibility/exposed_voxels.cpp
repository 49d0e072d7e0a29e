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

/// One row of a map's bit planes and its neighbours towards the camera. What lies outside of the enclosure is empty.
class Row {
 public:
  /// `side_y` and `side_z`: signs of the way from the camera.
  Row(const VoxelMap& map, int side_y, int side_z, int y, int z) : layout_(map.layout()), y_(y), z_(z) {
    const auto row_of = [&](const BitPlane& plane, int row_y, int row_z) -> const std::uint64_t* {
      const bool is_inside = row_y >= 0 && row_y < layout_.size.y() && row_z >= 0 && row_z < layout_.size.z();
      return is_inside ? plane.words.data() + layout_.row(row_y, row_z) : nullptr;
    };
    empty_ = row_of(map.empty(), y, z);
    occupied_ = row_of(map.occupied(), y, z);
    hidden_ = row_of(map.hidden(), y, z);
    occplane_ = row_of(map.occplane(), y, z);
    empty_before_y_ = row_of(map.empty(), y - side_y, z);
    empty_before_z_ = row_of(map.empty(), y, z - side_z);
  }

  [[nodiscard]] std::uint64_t full(int w) const { return ~empty_[w] & layout_.row_mask(w); }
  /// Voxels whose neighbour towards the camera is empty, on at least one axis; empty ones among them.
  [[nodiscard]] std::uint64_t facing(int w, int side_x) const {
    constexpr std::uint64_t all = ~std::uint64_t{0};
    const auto empty = [&](int word) {
      return word < 0 || word >= layout_.words_per_row ? all : empty_[word] | ~layout_.row_mask(word);
    };
    const std::uint64_t along_x =
        side_x > 0 ? empty_[w] << 1U | empty(w - 1) >> 63U : empty(w) >> 1U | empty(w + 1) << 63U;
    return along_x | (empty_before_y_ ? empty_before_y_[w] : all) | (empty_before_z_ ? empty_before_z_[w] : all);
  }
  /// Appends the voxels of the given bits of a word, away from the camera.
  void pack(int w, std::uint64_t bits, int side_x, std::vector<std::uint32_t>& voxels) const {
    const std::uint64_t hidden = hidden_[w];
    const std::uint64_t marked = occupied_[w] | occplane_[w];
    const std::uint32_t place = static_cast<std::uint32_t>(64 * w) | static_cast<std::uint32_t>(y_) << 10U |
                                static_cast<std::uint32_t>(z_) << 20U;
    while (bits != 0) {
      const int bit = side_x > 0 ? std::countr_zero(bits) : 63 - std::countl_zero(bits);
      bits &= ~(std::uint64_t{1} << bit);
      voxels.push_back((place + static_cast<std::uint32_t>(bit)) |
                       static_cast<std::uint32_t>((hidden >> bit & 1U) << 31U | (marked >> bit & 1U) << 30U));
    }
  }

 private:
  const BitLayout& layout_;
  int y_, z_;
  const std::uint64_t *empty_, *occupied_, *hidden_, *occplane_, *empty_before_y_, *empty_before_z_;
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
  for (int code = 0; code < 8; ++code) {
    Region region;
    region.side = {(code & 1) != 0 ? -1 : 1, (code & 2) != 0 ? -1 : 1, (code & 4) != 0 ? -1 : 1};
    for (int a = 0; a < 3; ++a) {
      const bool is_positive = region.side_of(a) > 0;
      region.box.min[a] = is_positive ? std::max(0, camera_cell[a]) : 0;
      region.box.max[a] = is_positive ? size[a] - 1 : std::min(size[a] - 1, camera_cell[a] - 1);
    }
    if ((region.box.min.array() <= region.box.max.array()).all()) regions.push_back(region);
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
  has_octants_ = true;
  for (const int z : {-1, 1}) {
    for (const int y : {-1, 1}) {
      std::vector<std::uint32_t>& descending = octants_[octant_number({-1, y, z})];
      std::vector<std::uint32_t>& ascending = octants_[octant_number({1, y, z})];
      if (has_octants_) collect_octants(y, z, descending, ascending);
      if (std::max(descending.size(), ascending.size()) > largest_octant) has_octants_ = false;
    }
  }
  if (!has_octants_) octants_ = {};
}

/// Two octants at once, which differ in the direction of x alone: most of the time goes into finding the rows.
void ExposedVoxels::collect_octants(int side_y, int side_z, std::vector<std::uint32_t>& descending,
                                    std::vector<std::uint32_t>& ascending) const {
  const Index3& size = map_->layout().size;
  const Steps zs(0, size.z() - 1, side_z);
  const Steps ys(0, size.y() - 1, side_y);
  const int words = map_->layout().words_per_row;
  for (int z = zs.first; z != zs.end; z += zs.step) {
    for (int y = ys.first; y != ys.end; y += ys.step) {
      const Row row(*map_, side_y, side_z, y, z);
      for (int w = 0; w < words; ++w) {
        const std::uint64_t full = row.full(w);
        if (full != 0) row.pack(w, full & row.facing(w, 1), 1, ascending);
      }
      for (int w = words - 1; w >= 0; --w) {
        const std::uint64_t full = row.full(w);
        if (full != 0) row.pack(w, full & row.facing(w, -1), -1, descending);
      }
    }
  }
}

const std::vector<std::uint32_t>* ExposedVoxels::octant(const std::array<int, 3>& side) const {
  return has_octants_ ? &octants_[octant_number(side)] : nullptr;
}

void ExposedVoxels::collect(const Region& region, const FirstVoxels* first, std::vector<std::uint32_t>& voxels) const {
  const Steps zs(region.box.min.z(), region.box.max.z(), region.side[2]);
  const Steps ys(region.box.min.y(), region.box.max.y(), region.side[1]);
  const Steps ws(region.box.min.x() / 64, region.box.max.x() / 64, region.side[0]);
  for (int z = zs.first; z != zs.end; z += zs.step) {
    for (int y = ys.first; y != ys.end; y += ys.step) {
      const Row row(*map_, region.side[1], region.side[2], y, z);
      const std::array<int, 2> first_in_row = first ? first->in_row(y, z) : std::array{0, -1};
      for (int w = ws.first; w != ws.end; w += ws.step) {
        const std::uint64_t full = row.full(w) & bits_between(region.box.min.x(), region.box.max.x(), w);
        if (full == 0) continue;
        row.pack(w, full & (row.facing(w, region.side[0]) | bits_between(first_in_row[0], first_in_row[1], w)),
                 region.side[0], voxels);
      }
    }
  }
}

}  // namespace vantage
