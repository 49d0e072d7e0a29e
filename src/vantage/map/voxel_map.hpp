#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "vantage/map/grid.hpp"
#include "vantage/map/label.hpp"

namespace vantage {

/// What an occupied voxel knows of the surface in it.
struct SurfaceVoxel {
  Vec3 normal_sum = Vec3::Zero();  // of all points that ever fell into the voxel, world frame
  double quality = 0;              // best cosine between a point's normal and the direction back to the sensor

  void add(const Vec3& normal_in_world, double point_quality) {
    normal_sum += normal_in_world;
    quality = std::max(quality, point_quality);
  }
  /// The renormalised sum, or (0,0,0) where no point had a normal.
  [[nodiscard]] Vec3 normal() const;
};

/// One bit per voxel of the enclosure. A row runs along x in whole 64-bit words, x = 0 at bit 0; bits past the end of a
/// row stay 0. Rows follow each other along y, then z.
struct BitPlane {
  std::vector<std::uint64_t> words;
};

/// How the enclosure's voxels lie in the words of a bit plane. Indices here are local to the enclosure.
struct BitLayout {
  Index3 size = Index3::Zero();
  int words_per_row = 0;

  [[nodiscard]] std::size_t row(int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y()) + static_cast<std::size_t>(y)) *
           static_cast<std::size_t>(words_per_row);
  }
  [[nodiscard]] std::size_t word(const Index3& local) const {
    return row(local.y(), local.z()) + (static_cast<std::size_t>(local.x()) >> 6U);
  }
  [[nodiscard]] static std::uint64_t bit(const Index3& local) {
    return std::uint64_t{1} << (static_cast<unsigned>(local.x()) & 63U);
  }
  [[nodiscard]] std::size_t words() const {
    return static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(size.z()) *
           static_cast<std::size_t>(words_per_row);
  }
  /// The bits of word `w` of a row that belong to voxels.
  [[nodiscard]] std::uint64_t row_mask(int w) const {
    const int used = size.x() - 64 * w;
    return used >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << static_cast<unsigned>(used)) - 1;
  }
};

/// The scene with five labels per voxel (paper, section 4). Only the object enclosure is stored: everything outside it
/// is empty for ever. At the start the enclosure is unmarked.
class VoxelMap {
 public:
  /// Throws InputError where the enclosure does not lie in the grid or does not fit in memory.
  VoxelMap(const Grid& grid, const IndexBox& enclosure, MapRule rule = MapRule::paper);
  /// Throws InputError naming the option.
  explicit VoxelMap(const SceneOptions& options)
      : VoxelMap(validated(options).grid(), options.enclosure(), options.rule) {}

  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] const IndexBox& enclosure() const { return enclosure_; }
  /// Rounded to a nanometre, so that a scene around the origin has its center there and symmetric views stay symmetric.
  [[nodiscard]] Vec3 enclosure_center() const {
    return (grid_.box(enclosure_).center() * 1e9).array().round().matrix() / 1e9;
  }

  /// Indices are the scene's. Everything outside the enclosure is empty.
  [[nodiscard]] Label label(const Index3& index) const;
  /// The voxel must lie in the enclosure. Leaving `occupied` forgets the voxel's surface; a voxel that becomes occupied
  /// has none yet.
  void set_label(const Index3& index, Label label);
  /// Marks the voxel occupied and gives its surface, valid until the next voxel becomes occupied.
  struct Occupied {
    SurfaceVoxel& surface;
    bool is_new;
  };
  Occupied occupy(const Index3& index);
  /// Marks the voxel occupied and adds a measured point to it. A zero normal adds nothing to the normal and quality.
  /// Returns true where the voxel was not occupied before.
  bool add_point(const Index3& index, const Vec3& normal_in_world, double quality);

  [[nodiscard]] MapRule rule() const { return rule_; }
  /// Nothing counted outside of the enclosure and by the paper's rule.
  [[nodiscard]] VoxelEvidence evidence(const Index3& index) const;

  /// nullptr unless the voxel is occupied.
  [[nodiscard]] const SurfaceVoxel* surface(const Index3& index) const;
  /// Replaces the surface of an occupied voxel (files).
  void set_surface(const Index3& index, const SurfaceVoxel& surface);

  /// Number of voxels with this label in the whole scene.
  [[nodiscard]] std::int64_t count(Label label) const;
  /// Mean over all occupied voxels, 0 where there are none.
  [[nodiscard]] double mean_quality() const;
  /// Turns occluded voxels with an empty 6-neighbour into occplane and occplane voxels without one into occluded.
  /// Outside of the enclosure counts as empty.
  void update_occplane();
  /// All occupied voxels, x fastest. Scene indices.
  [[nodiscard]] std::vector<Index3> occupied_voxels() const;

  // The storage, for the fast paths. Planes: occupied, empty, hidden (occluded or occplane), occplane; no bit:
  // unmarked.
  [[nodiscard]] const BitLayout& layout() const { return layout_; }
  [[nodiscard]] const BitPlane& occupied() const { return occupied_; }
  [[nodiscard]] const BitPlane& empty() const { return empty_; }
  [[nodiscard]] const BitPlane& hidden() const { return hidden_; }
  [[nodiscard]] const BitPlane& occplane() const { return occplane_; }
  /// For one word of a row: `emptied` voxels become empty and `occluded` ones occluded where they were unmarked.
  /// Occupied voxels never change. Call update_occplane() after the last word. Safe for different words at the same
  /// time.
  void carve_word(std::size_t word, std::uint64_t emptied, std::uint64_t occluded);

  // The evidence, for the fast paths; by the rule `evidence` only.
  /// Voxels that a point ever fell into.
  [[nodiscard]] const BitPlane& touched() const { return touched_; }
  /// Counts points that fell into a voxel: `amount` is what they add to its support. Returns its surface where the
  /// voxel is occupied then, valid until the next voxel becomes occupied, and whether it was not before.
  struct Supported {
    SurfaceVoxel* surface;
    bool is_new;
  };
  Supported support(const Index3& index, int amount);
  /// Counts a scan that looked through these touched voxels of a word; those that are no longer occupied by it become
  /// empty. Returns how many do. Safe for different words at the same time.
  int contradict_word(std::size_t word, std::uint64_t looked_through);
  /// Unmarked voxels that a point fell into and that are not occupied become occluded: something may be there. The
  /// index is the scene's.
  void hide_if_unmarked(const Index3& index);

 private:
  [[nodiscard]] static const SceneOptions& validated(const SceneOptions& options) {
    options.validate();
    return options;
  }
  /// Calls `visit(local index)` for every occupied voxel, x fastest.
  template <class Visit>
  void visit_occupied(const Visit& visit) const;
  [[nodiscard]] const SurfaceVoxel& surface_of(const Index3& local_index) const;
  [[nodiscard]] Index3 local(const Index3& index) const { return index - enclosure_.min; }
  [[nodiscard]] SurfaceVoxel& surface_slot(const Index3& local_index);

  [[nodiscard]] VoxelEvidence& counts(const Index3& local_index) { return evidence_[place(local_index)]; }
  [[nodiscard]] std::size_t place(const Index3& local_index) const {
    const auto size = layout_.size.cast<std::size_t>().eval();
    const auto at = local_index.cast<std::size_t>().eval();
    return (at.z() * size.y() + at.y()) * size.x() + at.x();
  }

  Grid grid_;
  IndexBox enclosure_;
  MapRule rule_;
  BitLayout layout_;
  BitPlane occupied_, empty_, hidden_, occplane_;
  BitPlane touched_;                     // empty by the paper's rule, as are the counts
  std::vector<VoxelEvidence> evidence_;  // of all voxels, x fastest
  // Surfaces are rare: each word of the planes that holds an occupied voxel owns a block of 64 slots.
  using SurfaceBlock = std::array<std::int32_t, 64>;
  std::vector<std::int32_t> block_of_word_;
  std::vector<SurfaceBlock> blocks_;
  std::vector<SurfaceVoxel> surfaces_;
};

}  // namespace vantage
