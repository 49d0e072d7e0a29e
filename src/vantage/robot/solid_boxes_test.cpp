#include "vantage/robot/solid_boxes.hpp"

#include <gtest/gtest.h>

#include "support/random_scenes.hpp"

namespace vantage {
namespace {

TEST(SolidBoxes, FillWhatIsNotEmptyAndDoNotOverlap) {
  Random random(11);
  int solid_voxels = 0;
  int empty_voxels = 0;
  for (int scene = 0; scene < 60; ++scene) {
    VoxelMap map = test::unmarked_map(random);
    if (scene % 2 == 0) {
      test::fill_with_noise(map, random);
    } else {
      test::fill_with_blobs(map, random);
    }
    const std::vector<Box3> boxes = solid_boxes(map);
    for (const Index3& voxel : {map.enclosure().min, map.enclosure().max}) EXPECT_TRUE(map.grid().contains(voxel));
    test::set_labels(map, [&](const Index3& voxel) {
      int holding = 0;
      for (const Box3& box : boxes) holding += box.contains(map.grid().center(voxel)) ? 1 : 0;
      EXPECT_EQ(holding, map.label(voxel) == Label::empty ? 0 : 1);
      (map.label(voxel) == Label::empty ? empty_voxels : solid_voxels) += 1;
      return map.label(voxel);
    });
  }
  EXPECT_GT(solid_voxels, 5000);
  EXPECT_GT(empty_voxels, 5000);
}

TEST(SolidBoxes, AreFew) {
  const VoxelMap map{SceneOptions{}};  // 55^3 unmarked voxels
  const std::vector<Box3> boxes = solid_boxes(map);
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_TRUE(boxes.front().isApprox(map.grid().box(map.enclosure())));
}

}  // namespace
}  // namespace vantage
