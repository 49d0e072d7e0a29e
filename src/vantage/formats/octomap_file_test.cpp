#include "vantage/formats/octomap_file.hpp"

#include <gmock/gmock.h>
#include <octomap/octomap.h>

#include <sstream>

#include "support/test_folder.hpp"

namespace vantage {
namespace {

/// Random labels in blocks, so that there is something to prune.
VoxelMap random_map(const Grid& grid, const IndexBox& enclosure) {
  Random random(5);
  VoxelMap map(grid, enclosure);
  for (int block = 0; block < 60; ++block) {
    const Index3 size = enclosure.size();
    const Index3 corner =
        enclosure.min + Index3(random.index(size.x()), random.index(size.y()), random.index(size.z()));
    const Index3 end = (corner + Index3::Constant(1 + random.index(6))).cwiseMin(enclosure.max);
    const Label label = all_labels[static_cast<std::size_t>(random.index(5))];
    for (int z = corner.z(); z <= end.z(); ++z) {
      for (int y = corner.y(); y <= end.y(); ++y) {
        for (int x = corner.x(); x <= end.x(); ++x) map.set_label({x, y, z}, label);
      }
    }
  }
  return map;
}

enum class Seen { unknown, free, occupied };

Seen seen(Label label) {
  if (label == Label::occupied) return Seen::occupied;
  return label == Label::empty ? Seen::free : Seen::unknown;
}

Seen seen(const octomap::OcTree& tree, const Vec3& point) {
  const octomap::OcTreeNode* node = tree.search(point.x(), point.y(), point.z());
  if (node == nullptr) return Seen::unknown;
  return tree.isNodeOccupied(node) ? Seen::occupied : Seen::free;
}

/// Reads the bytes with OctoMap itself and asks it for every voxel of the enclosure and a border around it.
void expect_same_in_octomap(const VoxelMap& map, int cells_per_voxel) {
  const OctomapLattice lattice = octomap_lattice(map.grid());
  EXPECT_EQ(lattice.cells_per_voxel, cells_per_voxel);
  std::istringstream stream(octomap_bytes(map));
  octomap::OcTree tree(0.1);
  ASSERT_TRUE(tree.readBinary(stream));
  EXPECT_DOUBLE_EQ(tree.getResolution(), map.grid().length / cells_per_voxel);
  std::array<int, 3> counts{};
  const IndexBox& box = map.enclosure();
  for (int z = box.min.z() - 1; z <= box.max.z() + 1; ++z) {
    for (int y = box.min.y() - 1; y <= box.max.y() + 1; ++y) {
      for (int x = box.min.x() - 1; x <= box.max.x() + 1; ++x) {
        const Seen expected = box.contains({x, y, z}) ? seen(map.label({x, y, z})) : Seen::unknown;
        // All eight parts of the voxel, away from its middle, where a finer lattice has a border.
        for (int part = 0; part < 8; ++part) {
          const Vec3 offset = 0.25 * map.grid().length * Vec3(part & 1 ? 1 : -1, part & 2 ? 1 : -1, part & 4 ? 1 : -1);
          ASSERT_EQ(seen(tree, map.grid().center({x, y, z}) + lattice.shift + offset), expected)
              << x << " " << y << " " << z;
        }
        ++counts[static_cast<std::size_t>(expected)];
      }
    }
  }
  for (const int count : counts) EXPECT_GT(count, 100);
  const std::size_t nodes = tree.calcNumNodes();
  EXPECT_EQ(tree.size(), nodes) << "the size in the header is that of the tree";
  tree.prune();
  EXPECT_EQ(tree.calcNumNodes(), nodes) << "nothing is left to prune";
}

TEST(OctomapFile, OctomapReadsTheSameVoxels) {
  expect_same_in_octomap(random_map({{-0.4, -0.2, 0.6}, 0.02, {24, 20, 20}}, {{2, 3, 1}, {21, 17, 18}}), 1);
}

TEST(OctomapFile, TheScenesOfThePaperLieHalfAVoxelOffAndStayWhereTheyAre) {
  const SceneOptions scene{.scene_size = Index3::Constant(31), .enclosure_size = Index3::Constant(21)};
  EXPECT_EQ(octomap_lattice(scene.grid()).shift, Vec3(0, 0, 0));
  expect_same_in_octomap(random_map(scene.grid(), scene.enclosure()), 2);
}

TEST(OctomapFile, OtherScenesMoveByLessThanAVoxelAndSaySo) {
  const Grid grid{{-0.406, -0.2, 0.6}, 0.02, {24, 20, 20}};
  const OctomapLattice lattice = octomap_lattice(grid);
  EXPECT_TRUE(lattice.shift.isApprox(Vec3(0.006, 0, 0), 1e-9)) << lattice.shift.transpose();
  const VoxelMap map = random_map(grid, {{2, 3, 1}, {21, 17, 18}});
  expect_same_in_octomap(map, 1);
  EXPECT_THAT(octomap_bytes(map), testing::HasSubstr("# moved by (0.00"));
}

TEST(OctomapFile, AMapThatKnowsNothingIsAnEmptyTree) {
  std::istringstream stream(octomap_bytes(VoxelMap({{0, 0, 0}, 0.1, {4, 4, 4}}, {{0, 0, 0}, {3, 3, 3}})));
  octomap::OcTree tree(0.2);
  ASSERT_TRUE(tree.readBinary(stream));
  EXPECT_EQ(tree.size(), 0U);
}

TEST(OctomapFile, WhatOctomapCannotHoldAndUnwritablePathsAreErrors) {
  const VoxelMap far({{400, 0, 0}, 0.01, {4, 4, 4}}, {{0, 0, 0}, {3, 3, 3}});
  EXPECT_THAT(input_error_of([&] { (void)octomap_bytes(far); }),
              testing::HasSubstr("which has only those from -32768 to 32768"));
  const TestFolder folder;
  const VoxelMap map({{0, 0, 0}, 0.01, {4, 4, 4}}, {{0, 0, 0}, {3, 3, 3}});
  EXPECT_THAT(error_of([&] { write_octomap(map, folder / "none" / "a.bt"); }),
              testing::HasSubstr("a.bt: cannot be written"));
  write_octomap(map, folder / "a.bt");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.bt"});
}

}  // namespace
}  // namespace vantage
