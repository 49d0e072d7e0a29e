#include "vantage/map/voxel_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// The map as one label and one surface per voxel: slow and obvious.
class NaiveMap {
 public:
  explicit NaiveMap(const IndexBox& enclosure) : enclosure_(enclosure) {
    const Index3 size = enclosure.size();
    labels_.assign(static_cast<std::size_t>(size.prod()), Label::unmarked);
    surfaces_.resize(labels_.size());
  }

  [[nodiscard]] Label label(const Index3& index) const {
    return enclosure_.contains(index) ? labels_[at(index)] : Label::empty;
  }
  void set_label(const Index3& index, Label label) {
    if (label != labels_[at(index)]) surfaces_[at(index)] = {};
    labels_[at(index)] = label;
  }
  void add_point(const Index3& index, const Vec3& normal, double quality) {
    set_label(index, Label::occupied);
    if (!normal.isZero(0)) {
      surfaces_[at(index)].normal_sum += normal;
      surfaces_[at(index)].quality = std::max(quality, surfaces_[at(index)].quality);
    }
  }
  [[nodiscard]] const SurfaceVoxel& surface(const Index3& index) const { return surfaces_[at(index)]; }
  void carve(const Index3& index, bool emptied, bool occluded) {
    const Label before = label(index);
    if (before == Label::occupied) return;
    if (emptied) {
      set_label(index, Label::empty);
    } else if (occluded && before == Label::unmarked) {
      set_label(index, Label::occluded);
    }
  }
  void update_occplane() {
    for (const Index3& index : all()) {
      const Label here = label(index);
      if (here != Label::occluded && here != Label::occplane) continue;
      bool has_empty_neighbour = false;
      for (int a = 0; a < 3; ++a) {
        for (const int step : {-1, 1}) {
          if (label(index + step * Index3::Unit(a)) == Label::empty) has_empty_neighbour = true;
        }
      }
      set_label(index, has_empty_neighbour ? Label::occplane : Label::occluded);
    }
  }
  [[nodiscard]] std::vector<Index3> all() const {
    std::vector<Index3> voxels;
    for (int z = enclosure_.min.z(); z <= enclosure_.max.z(); ++z) {
      for (int y = enclosure_.min.y(); y <= enclosure_.max.y(); ++y) {
        for (int x = enclosure_.min.x(); x <= enclosure_.max.x(); ++x) voxels.emplace_back(x, y, z);
      }
    }
    return voxels;
  }

 private:
  [[nodiscard]] std::size_t at(const Index3& index) const {
    const Index3 local = index - enclosure_.min;
    const Index3 size = enclosure_.size();
    return static_cast<std::size_t>((local.z() * size.y() + local.y()) * size.x() + local.x());
  }

  IndexBox enclosure_;
  std::vector<Label> labels_;
  std::vector<SurfaceVoxel> surfaces_;
};

void expect_same(const VoxelMap& map, const NaiveMap& naive) {
  std::map<Label, std::int64_t> counts{{Label::empty, map.grid().size.cast<std::int64_t>().prod()}};
  std::vector<Index3> occupied;
  double quality_sum = 0;
  for (const Index3& index : naive.all()) {
    ASSERT_EQ(map.label(index), naive.label(index)) << index.transpose();
    --counts[Label::empty];
    ++counts[naive.label(index)];
    const SurfaceVoxel* surface = map.surface(index);
    ASSERT_EQ(surface != nullptr, naive.label(index) == Label::occupied);
    if (surface == nullptr) continue;
    occupied.push_back(index);
    quality_sum += surface->quality;
    ASSERT_EQ(surface->normal_sum, naive.surface(index).normal_sum);
    ASSERT_EQ(surface->quality, naive.surface(index).quality);
  }
  for (const Label label : all_labels) ASSERT_EQ(map.count(label), counts[label]) << name(label);
  ASSERT_EQ(map.occupied_voxels(), occupied);
  const double mean = occupied.empty() ? 0 : quality_sum / static_cast<double>(occupied.size());
  ASSERT_NEAR(map.mean_quality(), mean, 1e-14);
  for (int w = 0; w < map.layout().words_per_row; ++w) {
    for (int z = 0; z < map.layout().size.z(); ++z) {
      const std::size_t word = map.layout().row(0, z) + static_cast<std::size_t>(w);
      for (const BitPlane* plane : {&map.occupied(), &map.empty(), &map.hidden(), &map.occplane()}) {
        ASSERT_EQ(plane->words[word] & ~map.layout().row_mask(w), 0U) << "bits past the end of a row stay 0";
      }
    }
  }
}

// Row lengths on both sides of whole words.
constexpr std::array<int, 10> row_lengths{1, 2, 31, 63, 64, 65, 100, 128, 129, 200};

TEST(VoxelMap, DoesWhatANaiveMapDoes) {
  Random random(41);
  int scenes = 0;
  for (int scene = 0; scene < 300; ++scene) {
    const int length = row_lengths[static_cast<std::size_t>(random.index(10))];
    const IndexBox enclosure{Index3(3, 1, 2), Index3(2 + length, 1 + random.index(5), 2 + random.index(5))};
    VoxelMap map(Grid{Vec3::Zero(), 0.1, Index3(210, 8, 8)}, enclosure);
    NaiveMap naive(enclosure);
    const std::vector<Index3> voxels = naive.all();
    const auto any_voxel = [&] {
      return voxels[static_cast<std::size_t>(random.index(static_cast<int>(voxels.size())))];
    };
    for (int round = 0; round < 3; ++round) {
      const int operations = random.index(2 * static_cast<int>(voxels.size())) + 1;
      for (int i = 0; i < operations; ++i) {
        const Index3 index = any_voxel();
        if (random.uniform() < 0.5) {
          const Label label = all_labels[static_cast<std::size_t>(random.index(5))];
          map.set_label(index, label);
          naive.set_label(index, label);
        } else {
          const Vec3 normal = random.uniform() < 0.2 ? Vec3(Vec3::Zero()) : random.unit_vector();
          const double quality = random.uniform();
          const bool is_new = naive.label(index) != Label::occupied;
          ASSERT_EQ(map.add_point(index, normal, quality), is_new);
          naive.add_point(index, normal, quality);
        }
      }
      expect_same(map, naive);
      map.update_occplane();
      naive.update_occplane();
      expect_same(map, naive);
    }
    ++scenes;
  }
  EXPECT_EQ(scenes, 300);
}

TEST(VoxelMap, CarvingAWordIsCarvingItsVoxels) {
  Random random(42);
  int scenes = 0;
  for (int scene = 0; scene < 200; ++scene) {
    const int length = row_lengths[static_cast<std::size_t>(random.index(10))];
    const IndexBox enclosure{Index3(0, 0, 0), Index3(length - 1, 2, 2)};
    VoxelMap map(Grid{Vec3::Zero(), 0.1, Index3(210, 8, 8)}, enclosure);
    NaiveMap naive(enclosure);
    for (const Index3& index : naive.all()) {
      const Label label = all_labels[static_cast<std::size_t>(random.index(5))];
      map.set_label(index, label);
      naive.set_label(index, label);
    }
    for (int y = 0; y < 3; ++y) {
      for (int w = 0; w < map.layout().words_per_row; ++w) {
        const std::uint64_t emptied = random.bits() & random.bits() & map.layout().row_mask(w);
        const std::uint64_t occluded = random.bits() & map.layout().row_mask(w);
        map.carve_word(map.layout().row(y, 1) + static_cast<std::size_t>(w), emptied, occluded);
        for (int bit = 0; bit < 64 && 64 * w + bit < length; ++bit) {
          naive.carve({64 * w + bit, y, 1}, ((emptied >> bit) & 1U) != 0, ((occluded >> bit) & 1U) != 0);
        }
      }
    }
    map.update_occplane();
    naive.update_occplane();
    expect_same(map, naive);
    ++scenes;
  }
  EXPECT_EQ(scenes, 200);
}

TEST(VoxelMap, StartsUnmarkedInAnEmptyScene) {
  const VoxelMap map{SceneOptions{}};
  EXPECT_EQ(map.label(Index3::Constant(75)), Label::unmarked);
  EXPECT_EQ(map.label(Index3::Constant(74)), Label::empty);
  EXPECT_EQ(map.label(Index3::Constant(-9)), Label::empty);
  EXPECT_EQ(map.count(Label::unmarked), 55 * 55 * 55);
  EXPECT_EQ(map.count(Label::empty), 205LL * 205 * 205 - 55 * 55 * 55);
  EXPECT_EQ(map.mean_quality(), 0);
  EXPECT_LT(map.enclosure_center().norm(), 1e-12);
}

TEST(VoxelMap, NormalIsTheRenormalisedSumAndQualityTheBest) {
  VoxelMap map{SceneOptions{}};
  const Index3 voxel = Index3::Constant(100);
  EXPECT_TRUE(map.add_point(voxel, Vec3::Zero(), 0));
  EXPECT_EQ(map.surface(voxel)->normal(), Vec3::Zero()) << "no point has had a normal";
  EXPECT_FALSE(map.add_point(voxel, Vec3::UnitX(), 0.9));
  EXPECT_FALSE(map.add_point(voxel, Vec3::UnitY(), 0.3));
  EXPECT_TRUE(map.surface(voxel)->normal().isApprox(Vec3(1, 1, 0).normalized()));
  EXPECT_EQ(map.surface(voxel)->quality, 0.9);
  map.set_label(voxel, Label::occupied);
  EXPECT_EQ(map.surface(voxel)->quality, 0.9) << "it was occupied already";
  map.set_surface(voxel, {Vec3::UnitZ(), 0.1});
  EXPECT_EQ(map.surface(voxel)->normal(), Vec3::UnitZ());
  map.set_label(voxel, Label::empty);
  EXPECT_EQ(map.surface(voxel), nullptr);
  map.add_point(voxel, Vec3::Zero(), 0);
  EXPECT_EQ(map.surface(voxel)->quality, 0) << "it has forgotten its surface";
}

TEST(VoxelMap, OppositeNormalsCancelToNone) {
  VoxelMap map{SceneOptions{}};
  map.add_point(Index3::Constant(100), Vec3::UnitX(), 0.5);
  map.add_point(Index3::Constant(100), -Vec3::UnitX(), 0.5);
  EXPECT_EQ(map.surface(Index3::Constant(100))->normal(), Vec3::Zero());
}

TEST(VoxelMap, RefusesEnclosuresThatDoNotFit) {
  const Grid grid{Vec3::Zero(), 0.02, Index3(10, 10, 10)};
  EXPECT_THAT(([&] {
                (void)VoxelMap(grid, {Index3(0, 0, 0), Index3(9, 10, 9)});
              }),
              ThrowsMessage<InputError>(HasSubstr("must lie in the scene")));
  EXPECT_THAT(([&] {
                (void)VoxelMap(grid, {Index3(5, 0, 0), Index3(4, 9, 9)});
              }),
              ThrowsMessage<InputError>(HasSubstr("enclosure")));
  SceneOptions huge;
  huge.scene_size = huge.enclosure_size = Index3::Constant(4000);
  EXPECT_THAT([&] { (void)VoxelMap(huge); }, ThrowsMessage<InputError>(HasSubstr("does not fit in memory")));
  SceneOptions broken;
  broken.enclosure_size.x() = -1;
  EXPECT_THAT([&] { (void)VoxelMap(broken); }, ThrowsMessage<InputError>(HasSubstr("enclosure size")));
}

}  // namespace
}  // namespace vantage
