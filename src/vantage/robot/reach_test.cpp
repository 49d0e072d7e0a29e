#include "vantage/robot/reach.hpp"

#include <gtest/gtest.h>

#include "vantage/candidates/candidates.hpp"
#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

TEST(Reach, EightViewsOfThePapersCubeLieInTheUnmarkedEnclosure) {
  const VoxelMap map{SceneOptions{}};
  const Candidates cube = view_cube(17, Vec3::Constant(4.1), 0.82, 1.9, Vec3::Zero());
  int infeasible = 0;
  for (const View& view : cube.views) {
    if (const auto reason = why_infeasible(map, view, {})) {
      EXPECT_NE(reason->find("unmarked voxel"), std::string::npos) << *reason;
      ++infeasible;
    }
  }
  EXPECT_EQ(cube.views.size(), 1932U);
  EXPECT_EQ(infeasible, 8);
}

TEST(Reach, TheBodyMayNotTouchWhatIsNotKnownToBeEmpty) {
  VoxelMap map{SceneOptions{}};  // the enclosure ends at x = 0.55
  ReachOptions options;
  const View view = view_towards(Vec3(0.80, 0, 0), Vec3::Zero());
  options.body_radius = 0.24;
  EXPECT_FALSE(why_infeasible(map, view, options));
  options.body_radius = 0.26;
  EXPECT_TRUE(why_infeasible(map, view, options));
  // Once the near side is known to be empty, the body fits.
  for (int z = 75; z <= 129; ++z) {
    for (int y = 75; y <= 129; ++y) map.set_label({129, y, z}, Label::empty);
  }
  EXPECT_FALSE(why_infeasible(map, view, options));
}

TEST(Reach, AgreesWithAllVoxelsAskedOneByOne) {
  Random random(5);
  SceneOptions scene;
  scene.voxel_length = 0.1;
  scene.scene_size = Index3(30, 30, 30);
  scene.enclosure_size = Index3(8, 6, 10);
  VoxelMap map(scene);
  const IndexBox box = map.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        if (random.uniform() < 0.9) map.set_label({x, y, z}, Label::empty);
      }
    }
  }
  int touching = 0;
  int free = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 position(random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9));
    if (position.norm() < 1e-3) continue;
    ReachOptions options;
    options.body_radius = random.uniform(0, 0.4);
    bool expected = false;
    for (int z = box.min.z(); z <= box.max.z(); ++z) {
      for (int y = box.min.y(); y <= box.max.y(); ++y) {
        for (int x = box.min.x(); x <= box.max.x(); ++x) {
          if (map.label({x, y, z}) == Label::empty) continue;
          const Vec3 nearest =
              position.cwiseMax(map.grid().corner({x, y, z})).cwiseMin(map.grid().corner({x + 1, y + 1, z + 1}));
          expected = expected || (position - nearest).norm() <= options.body_radius;
        }
      }
    }
    EXPECT_EQ(why_infeasible(map, view_towards(position, Vec3::Zero()), options).has_value(), expected);
    ++(expected ? touching : free);
  }
  EXPECT_GT(touching, 300);
  EXPECT_GT(free, 300);
}

TEST(Reach, KeepsToTheWorkspaceAndClearOfObstacles) {
  const VoxelMap map{SceneOptions{}};
  ReachOptions options;
  options.workspace = Box3(Vec3(-3, -3, 0), Vec3(3, 3, 3));
  options.obstacles = {Box3(Vec3(1, -1, 0), Vec3(2, 1, 1))};
  options.body_radius = 0.1;
  EXPECT_EQ(why_infeasible(map, view_towards(Vec3(0, 0, -2), Vec3::Zero()), options), "outside the workspace");
  EXPECT_EQ(why_infeasible(map, view_towards(Vec3(1.5, 0, 1.05), Vec3::Zero()), options),
            "the body touches obstacle 1");
  EXPECT_FALSE(why_infeasible(map, view_towards(Vec3(1.5, 0, 1.15), Vec3::Zero()), options));
}

TEST(ReachOptions, NameTheBadValue) {
  ReachOptions options;
  options.body_radius = -0.1;
  EXPECT_THROW(options.validate(), InputError);
  options = {};
  options.workspace = Box3(Vec3(1, 0, 0), Vec3(0, 1, 1));
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vantage
