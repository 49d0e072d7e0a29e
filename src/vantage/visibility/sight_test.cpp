#include "vantage/visibility/sight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "support/random_scenes.hpp"
#include "vantage/visibility/visibility.hpp"
#include "vantage/visibility/voxel_place.hpp"

namespace vantage {
namespace {

using test::MapKind;
using test::Stand;

/// A column of voxels along x, the rest empty; a narrow camera looks along -x at it.
struct Column {
  Grid grid{Vec3::Constant(-0.5), 1.0, Index3(8, 1, 1)};
  VoxelMap map{grid, {Index3::Zero(), Index3(7, 0, 0)}};
  RangeCamera camera = [] {
    RangeCamera narrow = camera_from_apertures(radians(0.1), radians(0.1), {2, 2});
    narrow.max_depth = 100;
    return narrow;
  }();
  View view = view_towards({20, 0.1, 0.1}, {0, 0.1, 0.1});

  explicit Column(const std::vector<Label>& labels) {
    for (int x = 0; x < 8; ++x) map.set_label({x, 0, 0}, labels[static_cast<std::size_t>(x)]);
  }
  void set_normal(int x, const Vec3& normal) { map.add_point({x, 0, 0}, normal, 1); }
  [[nodiscard]] Sight see() const { return see_past_grazing_exactly(map, camera, view, {2, 2}); }
};

const Vec3 edge_on(0, 0, 1);
const Vec3 facing(1, 0, 0);
constexpr Label empty = Label::empty, occupied = Label::occupied, unmarked = Label::unmarked;

TEST(SightPastGrazing, EndsAtTheFirstUnknownVoxel) {
  const Column column({unmarked, unmarked, unmarked, unmarked, Label::occplane, empty, empty, empty});
  EXPECT_EQ(column.see(), (Sight{{}, {{4, 0, 0}}}));
}

TEST(SightPastGrazing, PassesOneVoxelThatIsSeenEdgeOn) {
  Column column({unmarked, unmarked, unmarked, unmarked, occupied, occupied, empty, empty});
  column.set_normal(5, edge_on);
  column.set_normal(4, edge_on);
  EXPECT_EQ(column.see(), (Sight{{{4, 0, 0}, {5, 0, 0}}, {}})) << "the second one ends the ray";
  column.map.set_label({4, 0, 0}, empty);
  EXPECT_EQ(column.see(), (Sight{{{5, 0, 0}}, {{3, 0, 0}}})) << "unknown space behind one";
}

TEST(SightPastGrazing, EndsAtASurfaceThatFacesTheSensor) {
  Column column({unmarked, unmarked, unmarked, unmarked, unmarked, occupied, empty, empty});
  column.set_normal(5, facing);
  EXPECT_EQ(column.see(), (Sight{{{5, 0, 0}}, {}}));
  // cos = 0.31, just above the limit, and just below it.
  column = Column({unmarked, unmarked, unmarked, unmarked, unmarked, occupied, empty, empty});
  column.set_normal(5, Vec3(0.31, 0, std::sqrt(1 - 0.31 * 0.31)));
  EXPECT_TRUE(column.see().unknown.empty());
  column = Column({unmarked, unmarked, unmarked, unmarked, unmarked, occupied, empty, empty});
  column.set_normal(5, Vec3(-0.29, 0, std::sqrt(1 - 0.29 * 0.29)));
  EXPECT_EQ(column.see().unknown, (std::vector<Index3>{{4, 0, 0}}));
}

TEST(SightPastGrazing, LeavesOutWhatTheIncidenceLimitDoesNotLetTheSensorMeasure) {
  Column column({unmarked, unmarked, unmarked, unmarked, unmarked, occupied, empty, empty});
  column.set_normal(5, edge_on);
  column.camera.max_incidence = radians(80);
  EXPECT_EQ(column.see(), (Sight{{}, {{4, 0, 0}}}));
}

struct SightFamily {
  MapKind map;
  Stand stand;
};

class RandomSights : public ::testing::TestWithParam<SightFamily> {};

TEST_P(RandomSights, TheEvaluatorSeesWhatExactRaysSee) {
  constexpr int scenes = 250;
  const auto [kind, stand] = GetParam();
  Random random(29, 10 * static_cast<std::uint64_t>(kind) + static_cast<std::uint64_t>(stand));
  const std::vector<InstructionSet> instruction_sets = available_instruction_sets();
  int compared = 0;
  int with_unknown = 0;
  int with_a_pass = 0;
  for (int scene = 0; scene < scenes; ++scene) {
    const VoxelMap map = test::random_map(random, kind);
    const View view = test::random_view(map, random, stand);
    const RangeCamera camera = test::random_camera(map, view, random);
    const Resolution resolution = test::random_resolution(random);
    const GrazingPass pass{random.uniform() < 0.2 ? 1.0 : random.uniform(0, 0.6)};
    const Sight expected = see_past_grazing_exactly(map, camera, view, resolution, pass);
    for (const InstructionSet set : instruction_sets) {
      const SightEvaluator evaluator(map, pass, set);
      ASSERT_EQ(evaluator.see(camera, view, resolution), expected) << name(set) << ", scene " << scene;
      const SightEvaluator::PackedSight packed = evaluator.see_packed(camera, view, resolution);
      ASSERT_EQ(packed.occupied, static_cast<std::int64_t>(expected.occupied.size()));
      ASSERT_EQ(packed.unknown.size(), expected.unknown.size());
      ++compared;
    }
    with_unknown += !expected.unknown.empty();
    with_a_pass += see_past_grazing_exactly(map, camera, view, resolution, {0}) != expected;
  }
  EXPECT_EQ(compared, scenes * static_cast<int>(instruction_sets.size()));
  EXPECT_GT(with_unknown, scenes / 3);
  EXPECT_GT(with_a_pass, scenes / 20);
}

std::vector<SightFamily> families() {
  std::vector<SightFamily> all;
  for (const MapKind kind : test::map_kinds) {
    for (const Stand stand : test::stands) all.push_back({kind, stand});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Visibility, RandomSights, ::testing::ValuesIn(families()));

TEST(Sight, PlacesAreThoseOfTheVoxelsAlsoBeyondTenBits) {
  Random random(5);
  int places = 0;
  for (const Index3& size : {Index3(1500, 5, 4), Index3(4, 1500, 5), Index3(5, 4, 1500), Index3(30, 20, 10)}) {
    const Grid grid{Vec3::Zero(), 0.02, size};
    VoxelMap map(grid, grid.all());
    const Vec3 middle = 0.01 * size.cast<double>();
    const View view = view_towards(middle + Vec3(0.4, 0.5, 0.6), middle + 0.9 * middle.cwiseProduct(Vec3(1, 1, 1)));
    const SightEvaluator evaluator(map);
    const RangeCamera camera = camera_from_apertures(radians(100), radians(100), {40, 40});
    const SightEvaluator::PackedSight packed = evaluator.see_packed(camera, view, {40, 40});
    std::vector<Index3> voxels;
    for (const std::uint32_t place : packed.unknown) voxels.push_back(voxel_at(map.layout(), place));
    std::sort(voxels.begin(), voxels.end(), [](const Index3& a, const Index3& b) {
      return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
    });
    EXPECT_EQ(voxels, see_past_grazing_exactly(map, camera, view, {40, 40}).unknown);
    places += static_cast<int>(voxels.size());
  }
  EXPECT_GT(places, 200);
}

}  // namespace
}  // namespace vantage
