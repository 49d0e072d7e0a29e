#include <gtest/gtest.h>

#include "support/test_folder.hpp"
#include "vantage/formats/map_file.hpp"

namespace vantage {
namespace {

TEST(MapFile, TheLargestSceneOfThePaperIsWrittenAndRead) {
  VoxelMap map(SceneOptions{
      .voxel_length = 4.1 / 405, .scene_size = Index3::Constant(405), .enclosure_size = Index3::Constant(109)});
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    const Index3 voxel = map.enclosure().min + Index3(random.index(109), random.index(109), random.index(109));
    map.add_point(voxel, random.unit_vector(), random.uniform());
  }
  const TestFolder folder;
  write_map(map, folder / "a.nrrd");
  EXPECT_GT(std::filesystem::file_size(folder / "a.nrrd"), 405UL * 405 * 405);
  const VoxelMap again = read_map(folder / "a.nrrd");
  EXPECT_EQ(again.grid().min, map.grid().min);
  EXPECT_EQ(again.occupied_voxels(), map.occupied_voxels());
  EXPECT_EQ(again.count(Label::unmarked), map.count(Label::unmarked));
  EXPECT_NEAR(again.mean_quality(), map.mean_quality(), 1e-7);
}

}  // namespace
}  // namespace vantage
