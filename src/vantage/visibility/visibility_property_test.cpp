#include <gtest/gtest.h>

#include "support/random_scenes.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage {
namespace {

using test::MapKind;
using test::Stand;

struct Family {
  MapKind map;
  Stand stand;
};

class RandomScenes : public ::testing::TestWithParam<Family> {};

TEST_P(RandomScenes, TheEvaluatorSeesWhatExactRaysSee) {
  constexpr int scenes = 400;
  const auto [kind, stand] = GetParam();
  Random random(17, 10 * static_cast<std::uint64_t>(kind) + static_cast<std::uint64_t>(stand));
  const std::vector<InstructionSet> instruction_sets = available_instruction_sets();
  int compared = 0;
  int with_something_to_see = 0;
  std::int64_t voxels = 0;
  for (int scene = 0; scene < scenes; ++scene) {
    const VoxelMap map = test::random_map(random, kind);
    const View view = test::random_view(map, random, stand);
    const RangeCamera camera = test::random_camera(map, view, random);
    const Resolution resolution = test::random_resolution(random);
    const std::vector<Index3> expected = visible_voxels_exactly(map, camera, view, resolution);
    const Visibility expected_counts = see_exactly(map, camera, view, resolution);
    for (const InstructionSet set : instruction_sets) {
      const VisibilityEvaluator evaluator(map, set);
      ASSERT_EQ(evaluator.visible_voxels(camera, view, resolution), expected) << name(set) << ", scene " << scene;
      ASSERT_EQ(evaluator.see(camera, view, resolution), expected_counts) << name(set) << ", scene " << scene;
      ++compared;
    }
    with_something_to_see += !expected.empty();
    voxels += static_cast<std::int64_t>(expected.size());
  }
  EXPECT_EQ(compared, scenes * static_cast<int>(instruction_sets.size()));
  EXPECT_GT(with_something_to_see, scenes / 3);
  EXPECT_GT(voxels, 4 * scenes);
}

std::vector<Family> families() {
  std::vector<Family> all;
  for (const MapKind kind : test::map_kinds) {
    for (const Stand stand : test::stands) all.push_back({kind, stand});
  }
  return all;
}

std::string family_name(const ::testing::TestParamInfo<Family>& info) {
  const char* const maps[] = {"Noise", "Blobs", "Scans"};
  const char* const places[] = {"Outside", "Inside", "OnTheLattice", "Grazing"};
  return std::string(maps[static_cast<int>(info.param.map)]) + places[static_cast<int>(info.param.stand)];
}

INSTANTIATE_TEST_SUITE_P(Visibility, RandomScenes, ::testing::ValuesIn(families()), family_name);

}  // namespace
}  // namespace vantage
