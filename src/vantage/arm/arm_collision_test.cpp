#include "vantage/arm/arm_collision.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/sample_arm.hpp"

namespace vantage {
namespace {

/// Voxels of 4 cm around a place in front of the arm; all are empty but those that `is_solid` chooses.
template <class IsSolid>
VoxelMap map_in_front(const IsSolid& is_solid) {
  SceneOptions scene;
  scene.center = Vec3(0.5, 0, 0.4);
  scene.voxel_length = 0.04;
  scene.scene_size = scene.enclosure_size = Index3::Constant(21);
  VoxelMap map(scene);
  for (int z = 0; z < 21; ++z) {
    for (int y = 0; y < 21; ++y) {
      for (int x = 0; x < 21; ++x) {
        if (!is_solid(map.grid().center({x, y, z}))) map.set_label({x, y, z}, Label::empty);
      }
    }
  }
  return map;
}

/// A place inside a solid, of any kind.
Vec3 random_place_in(const LinkShape& shape, Random& random) {
  Vec3 place(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
  if (shape.kind == LinkShape::Kind::cylinder) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double radius = shape.size.x() * std::sqrt(random.uniform());
    place = Vec3(radius * std::cos(angle), radius * std::sin(angle), shape.size.y() * place.z());
  } else {
    place = place.cwiseProduct(shape.size);
  }
  return shape.joint_from_shape * place;
}

/// By definition: whether some of many places in the moving links are no farther than `distance` from a solid voxel.
bool is_near_a_solid_voxel(const ArmKinematics& arm, const Eigen::VectorXd& joints, const std::vector<Box3>& voxels,
                           double distance, Random& random) {
  const std::vector<Pose> frames = arm.world_from_joints(joints);
  for (const ArmBody& body : arm.arm().bodies) {
    if (body.joint < 0) continue;
    for (const LinkShape& shape : body.shapes) {
      for (int i = 0; i < 1000; ++i) {
        const Vec3 place = frames[static_cast<std::size_t>(body.joint)] * random_place_in(shape, random);
        for (const Box3& voxel : voxels) {
          if (voxel.exteriorDistance(place) <= distance) return true;
        }
      }
    }
  }
  return false;
}

std::vector<Box3> solid_voxels(const VoxelMap& map) {
  std::vector<Box3> voxels;
  for (int z = 0; z < 21; ++z) {
    for (int y = 0; y < 21; ++y) {
      for (int x = 0; x < 21; ++x) {
        const Index3 voxel(x, y, z);
        if (map.label(voxel) != Label::empty) voxels.push_back(map.grid().box({voxel, voxel}));
      }
    }
  }
  return voxels;
}

struct ArmAmongVoxels : public ::testing::Test {
  ArmKinematics arm{test::sample_arm(), Pose::Identity()};
  Random random{5};
};

TEST_F(ArmAmongVoxels, NoPlaceOfAFreeArmIsInASolidVoxel) {
  const VoxelMap map = map_in_front([this](const Vec3&) { return random.uniform() < 0.005; });
  const std::vector<Box3> voxels = solid_voxels(map);
  const ArmCollision collision(arm, 1e-6, {map});
  const ArmCollision alone(arm, 1e-6);
  int free = 0, touching = 0, near = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::VectorXd joints = test::random_joints(arm.arm(), random);
    if (alone.why_touching(joints)) continue;
    if (collision.why_touching(joints)) {
      ++touching;
      near += is_near_a_solid_voxel(arm, joints, voxels, 0.02, random) ? 1 : 0;
    } else {
      ++free;
      EXPECT_FALSE(is_near_a_solid_voxel(arm, joints, voxels, 0, random));
    }
  }
  EXPECT_GT(free, 30);
  EXPECT_GT(touching, 30);
  EXPECT_EQ(near, touching);
}

TEST_F(ArmAmongVoxels, AClearMoveTouchesNothingAnywhere) {
  const VoxelMap map = map_in_front([this](const Vec3&) { return random.uniform() < 0.004; });
  const std::vector<Box3> table{Box3(Vec3(-1, -1, -0.1), Vec3(1, 1, 0))};
  const ArmCollision collision(arm, 0.01, {map, table});
  const ArmCollision exact(arm, 0, {map, table});
  int clear = 0, blocked = 0;
  for (int i = 0; i < 150; ++i) {
    const Eigen::VectorXd from = test::random_joints(arm.arm(), random);
    const Eigen::VectorXd to = from + 0.15 * (test::random_joints(arm.arm(), random) - from);
    if (!collision.is_clear(from, to)) {
      ++blocked;
      continue;
    }
    ++clear;
    for (int step = 0; step <= 200; ++step) {
      const auto reason = exact.why_touching(from + step / 200.0 * (to - from));
      ASSERT_FALSE(reason) << *reason;
    }
  }
  EXPECT_GT(clear, 8);
  EXPECT_GT(blocked, 30);
}

TEST_F(ArmAmongVoxels, SaysWhatTouches) {
  const VoxelMap map = map_in_front([](const Vec3& place) { return (place - Vec3(0.5, 0, 0.4)).norm() < 0.1; });
  const std::vector<Box3> table{Box3(Vec3(-1, -1, -0.1), Vec3(1, 1, 0))};
  const ArmCollision collision(arm, 0.01, {map, table});
  EXPECT_FALSE(collision.why_touching(Eigen::VectorXd::Zero(6))) << "straight up; the base may stand on the table";
  Eigen::VectorXd joints = Eigen::VectorXd::Zero(6);
  joints[1] = radians(120);
  EXPECT_THAT(collision.why_touching(joints).value_or(""), testing::HasSubstr("touches what is not known to be free"));
  joints[1] = 0;
  joints[2] = radians(165);
  EXPECT_THAT(collision.why_touching(joints).value_or(""), testing::HasSubstr("touches link"));
}

}  // namespace
}  // namespace vantage
