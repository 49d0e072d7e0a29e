#include <gtest/gtest.h>

#include "support/analytic_scene.hpp"
#include "vantage/map/integrator.hpp"

namespace vantage {
namespace {

// The largest sizes promised: 512 voxels per side and images of 2048 x 2048 pixels.
TEST(Integrator, LargestEnclosureAndImage) {
  SceneOptions options;
  options.voxel_length = 1.0 / 512;
  options.scene_size = Index3(520, 300, 140);
  options.enclosure_size = Index3(512, 290, 130);
  VoxelMap fast(options);
  VoxelMap exact(options);
  const test::AnalyticScene objects{{{Vec3(0.1, 0, 0), 0.12}, {Vec3(-0.3, 0.1, 0), 0.1}},
                                    {Box3(Vec3(-0.4, -0.2, -0.1), Vec3(0.4, 0.2, -0.08))}};
  RangeCamera camera;
  camera.resolution = {2048, 2048};
  Random random(9);
  for (const Vec3& position : {Vec3(1.2, 0.5, 0.7), Vec3(0, 0, 1.5)}) {
    const View view = view_towards(position, Vec3::Zero());
    RangeImage image = objects.scan(camera, view);
    test::disturb(image, 0.001, 0.01, 0.01, random);
    ASSERT_FALSE(rays_are_faster(fast, camera, view));
    integrate(fast, image, {}, view);
    integrate_exactly(exact, sight_lines(image, {}, view));
    ASSERT_EQ(fast.occupied().words, exact.occupied().words);
    ASSERT_EQ(fast.empty().words, exact.empty().words);
    ASSERT_EQ(fast.hidden().words, exact.hidden().words);
    ASSERT_EQ(fast.occplane().words, exact.occplane().words);
  }
  for (const Label label : {Label::occupied, Label::empty, Label::occluded, Label::occplane}) {
    EXPECT_GT(fast.count(label), 10000) << name(label);
  }
}

}  // namespace
}  // namespace vantage
