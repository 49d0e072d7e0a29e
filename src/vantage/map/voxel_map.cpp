#include "vantage/map/voxel_map.hpp"

#include <bit>
#include <cassert>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr std::int64_t max_enclosure_voxels = std::int64_t{1} << 31;  // a quarter of a gigabyte per bit plane

std::int64_t count_bits(const BitPlane& plane) {
  std::int64_t sum = 0;
  for (const std::uint64_t word : plane.words) sum += std::popcount(word);
  return sum;
}

void assign(BitPlane& plane, std::size_t word, std::uint64_t bit, bool value) {
  plane.words[word] = value ? plane.words[word] | bit : plane.words[word] & ~bit;
}

}  // namespace

Vec3 SurfaceVoxel::normal() const {
  const double length = normal_sum.norm();
  return length > 1e-12 ? Vec3(normal_sum / length) : Vec3(Vec3::Zero());
}

VoxelMap::VoxelMap(const Grid& grid, const IndexBox& enclosure, MapRule rule)
    : grid_(grid), enclosure_(enclosure), rule_(rule) {
  grid.validate();
  require((enclosure.min.array() <= enclosure.max.array()).all() && grid.contains(enclosure.min) &&
              grid.contains(enclosure.max),
          "enclosure ", enclosure.min.transpose(), " .. ", enclosure.max.transpose(), " must lie in the scene of ",
          grid.size.transpose(), " voxels");
  const Eigen::Matrix<std::int64_t, 3, 1> sides = enclosure.size().cast<std::int64_t>();
  require(sides.prod() <= max_enclosure_voxels, "enclosure of ", sides.transpose(), " voxels (", sides.prod(),
          ") does not fit in memory; must be at most ", max_enclosure_voxels,
          " voxels: use longer voxels or a smaller box");
  layout_.size = enclosure.size();
  layout_.words_per_row = (layout_.size.x() + 63) / 64;
  for (BitPlane* plane : {&occupied_, &empty_, &hidden_, &occplane_}) plane->words.assign(layout_.words(), 0);
  block_of_word_.assign(layout_.words(), -1);
  if (rule_ == MapRule::evidence) {
    touched_.words.assign(layout_.words(), 0);
    evidence_.resize(static_cast<std::size_t>(sides.prod()));
  }
}

Label VoxelMap::label(const Index3& index) const {
  if (!enclosure_.contains(index)) return Label::empty;
  const Index3 at = local(index);
  const std::size_t word = layout_.word(at);
  const std::uint64_t bit = BitLayout::bit(at);
  if (occupied_.words[word] & bit) return Label::occupied;
  if (empty_.words[word] & bit) return Label::empty;
  if (occplane_.words[word] & bit) return Label::occplane;
  if (hidden_.words[word] & bit) return Label::occluded;
  return Label::unmarked;
}

void VoxelMap::set_label(const Index3& index, Label label) {
  assert(enclosure_.contains(index));
  const Index3 at = local(index);
  const std::size_t word = layout_.word(at);
  const std::uint64_t bit = BitLayout::bit(at);
  const bool was_occupied = (occupied_.words[word] & bit) != 0;
  if (was_occupied && label == Label::occupied) return;
  assign(occupied_, word, bit, label == Label::occupied);
  assign(empty_, word, bit, label == Label::empty);
  assign(hidden_, word, bit, label == Label::occluded || label == Label::occplane);
  assign(occplane_, word, bit, label == Label::occplane);
  if (was_occupied || label == Label::occupied) surface_slot(at) = {};
}

VoxelMap::Occupied VoxelMap::occupy(const Index3& index) {
  const Index3 at = local(index);
  const bool is_new = (occupied_.words[layout_.word(at)] & BitLayout::bit(at)) == 0;
  if (is_new) set_label(index, Label::occupied);
  return {surface_slot(at), is_new};
}

bool VoxelMap::add_point(const Index3& index, const Vec3& normal_in_world, double quality) {
  const auto [surface, is_new] = occupy(index);
  if (!normal_in_world.isZero(0)) surface.add(normal_in_world, quality);
  return is_new;
}

VoxelEvidence VoxelMap::evidence(const Index3& index) const {
  if (evidence_.empty() || !enclosure_.contains(index)) return {};
  return evidence_[place(local(index))];
}

VoxelMap::Supported VoxelMap::support(const Index3& index, int amount) {
  const Index3 at = local(index);
  const std::size_t word = layout_.word(at);
  const std::uint64_t bit = BitLayout::bit(at);
  VoxelEvidence& counted = counts(at);
  // Scans before the first point count as one that looked through, if any emptied the voxel.
  if ((touched_.words[word] & bit) == 0 && (empty_.words[word] & bit) != 0) counted.add_contradiction();
  touched_.words[word] |= bit;
  counted.add_support(amount);
  if (!counted.is_occupied()) return {nullptr, false};
  const auto [surface, is_new] = occupy(index);
  return {&surface, is_new};
}

int VoxelMap::contradict_word(std::size_t word, std::uint64_t looked_through) {
  int emptied = 0;
  const auto words_per_row = static_cast<std::size_t>(layout_.words_per_row);
  const auto columns = static_cast<std::size_t>(layout_.size.x());
  const std::size_t first = word / words_per_row * columns + word % words_per_row * 64;
  for (std::uint64_t bits = looked_through & touched_.words[word]; bits != 0; bits &= bits - 1) {
    VoxelEvidence& counted = evidence_[first + static_cast<std::size_t>(std::countr_zero(bits))];
    counted.add_contradiction();
    const std::uint64_t bit = bits & (~bits + 1);
    if ((occupied_.words[word] & bit) == 0 || counted.is_occupied()) continue;
    occupied_.words[word] &= ~bit;
    empty_.words[word] |= bit;
    ++emptied;
  }
  return emptied;
}

void VoxelMap::hide_if_unmarked(const Index3& index) {
  if (label(index) == Label::unmarked) set_label(index, Label::occluded);
}

SurfaceVoxel& VoxelMap::surface_slot(const Index3& local_index) {
  std::int32_t& block = block_of_word_[layout_.word(local_index)];
  if (block < 0) {
    block = static_cast<std::int32_t>(blocks_.size());
    blocks_.emplace_back().fill(-1);
  }
  std::int32_t& slot = blocks_[static_cast<std::size_t>(block)][static_cast<std::size_t>(local_index.x()) & 63U];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(surfaces_.size());
    surfaces_.emplace_back();
  }
  return surfaces_[static_cast<std::size_t>(slot)];
}

const SurfaceVoxel& VoxelMap::surface_of(const Index3& local_index) const {
  const SurfaceBlock& block = blocks_[static_cast<std::size_t>(block_of_word_[layout_.word(local_index)])];
  return surfaces_[static_cast<std::size_t>(block[static_cast<std::size_t>(local_index.x()) & 63U])];
}

const SurfaceVoxel* VoxelMap::surface(const Index3& index) const {
  return label(index) == Label::occupied ? &surface_of(local(index)) : nullptr;
}

void VoxelMap::set_surface(const Index3& index, const SurfaceVoxel& surface) {
  assert(label(index) == Label::occupied);
  surface_slot(local(index)) = surface;
}

std::int64_t VoxelMap::count(Label label) const {
  const Eigen::Matrix<std::int64_t, 3, 1> sides = layout_.size.cast<std::int64_t>();
  const std::int64_t inside = sides.prod();
  switch (label) {
    case Label::occupied:
      return count_bits(occupied_);
    case Label::empty:
      return count_bits(empty_) + grid_.size.cast<std::int64_t>().prod() - inside;
    case Label::occplane:
      return count_bits(occplane_);
    case Label::occluded:
      return count_bits(hidden_) - count_bits(occplane_);
    case Label::unmarked:
      break;
  }
  return inside - count_bits(occupied_) - count_bits(empty_) - count_bits(hidden_);
}

template <class Visit>
void VoxelMap::visit_occupied(const Visit& visit) const {
  for (int z = 0; z < layout_.size.z(); ++z) {
    for (int y = 0; y < layout_.size.y(); ++y) {
      for (int w = 0; w < layout_.words_per_row; ++w) {
        std::uint64_t bits = occupied_.words[layout_.row(y, z) + static_cast<std::size_t>(w)];
        for (; bits != 0; bits &= bits - 1) visit(Index3(64 * w + std::countr_zero(bits), y, z));
      }
    }
  }
}

double VoxelMap::mean_quality() const {
  double sum = 0;
  visit_occupied([&](const Index3& voxel) { sum += surface_of(voxel).quality; });
  const std::int64_t voxels = count(Label::occupied);
  return voxels > 0 ? sum / static_cast<double>(voxels) : 0;
}

std::vector<Index3> VoxelMap::occupied_voxels() const {
  std::vector<Index3> voxels;
  voxels.reserve(static_cast<std::size_t>(count(Label::occupied)));
  visit_occupied([&](const Index3& voxel) { voxels.emplace_back(enclosure_.min + voxel); });
  return voxels;
}

void VoxelMap::update_occplane() {
  const int ny = layout_.size.y();
  const int nz = layout_.size.z();
  const int words = layout_.words_per_row;
  constexpr std::uint64_t all = ~std::uint64_t{0};
  const auto empty_word = [&](int w, int y, int z) {
    const bool outside = y < 0 || y >= ny || z < 0 || z >= nz || w < 0 || w >= words;
    // Past the last voxel of a row the enclosure ends, and what lies outside is empty.
    return outside ? all : empty_.words[layout_.row(y, z) + static_cast<std::size_t>(w)] | ~layout_.row_mask(w);
  };
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int w = 0; w < words; ++w) {
        const std::size_t word = layout_.row(y, z) + static_cast<std::size_t>(w);
        const std::uint64_t hidden = hidden_.words[word];
        if (hidden == 0) {
          occplane_.words[word] = 0;
          continue;
        }
        const std::uint64_t here = empty_word(w, y, z);
        const std::uint64_t empty_neighbours =
            (here >> 1U | empty_word(w + 1, y, z) << 63U) | (here << 1U | empty_word(w - 1, y, z) >> 63U) |
            empty_word(w, y - 1, z) | empty_word(w, y + 1, z) | empty_word(w, y, z - 1) | empty_word(w, y, z + 1);
        occplane_.words[word] = hidden & empty_neighbours;
      }
    }
  }
}

void VoxelMap::carve_word(std::size_t word, std::uint64_t emptied, std::uint64_t occluded) {
  const std::uint64_t to_empty = emptied & ~occupied_.words[word];
  empty_.words[word] |= to_empty;
  hidden_.words[word] &= ~to_empty;
  occplane_.words[word] &= ~to_empty;
  hidden_.words[word] |= occluded & ~(occupied_.words[word] | empty_.words[word]);
}

}  // namespace vantage
