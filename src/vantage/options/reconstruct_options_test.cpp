#include "vantage/options/reconstruct_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

std::string complaint(const ReconstructOptions& options) {
  try {
    options.validate();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ReconstructOptions, AreValidByDefault) { EXPECT_EQ(complaint({}), ""); }

TEST(ReconstructOptions, NameWhatIsWrong) {
  using testing::HasSubstr;
  const auto with = [](const auto& change) {
    ReconstructOptions options;
    change(options);
    return complaint(options);
  };
  EXPECT_THAT(with([](auto& o) { o.camera = "45x0:320x320"; }), HasSubstr("aperture = 0 degrees"));
  EXPECT_THAT(with([](auto& o) { o.camera = "45x180:320x320"; }), HasSubstr("aperture = 180 degrees"));
  EXPECT_THAT(with([](auto& o) { o.camera = "45:320"; }), HasSubstr("HxV:COLUMNSxROWS"));
  EXPECT_THAT(with([](auto& o) { o.rays = "79"; }), HasSubstr("COLUMNSxROWS"));
  EXPECT_THAT(with([](auto& o) { o.rays = "0x79"; }), HasSubstr("1..16384"));
  EXPECT_THAT(with([](auto& o) { o.search = "random"; }), HasSubstr("exhaustive, multi-resolution"));
  EXPECT_THAT(with([](auto& o) { o.registration = "perfect"; }), HasSubstr("truth, none, icp"));
  EXPECT_THAT(with([](auto& o) { o.utility = "best"; }), HasSubstr("combined"));
  EXPECT_THAT(with([](auto& o) { o.positioning_error[1] = -0.1; }), HasSubstr("positioning-error"));
  EXPECT_THAT(with([](auto& o) { o.voxel = 0; }), HasSubstr("voxel length = 0"));
  EXPECT_THAT(with([](auto& o) { o.enclosure[0] = 300; }), HasSubstr("must fit into the scene"));
  EXPECT_THAT(with([](auto& o) { o.depth_range = {2, 1}; }), HasSubstr("max_depth = 1"));
  EXPECT_THAT(with([](auto& o) { o.max_views = 0; }), HasSubstr("max-views = 0"));
  EXPECT_THAT(with([](auto& o) { o.workspace = "1,2,3"; }), HasSubstr("3 numbers; must have 6"));
  EXPECT_THAT(with([](auto& o) { o.obstacles = "0,0,0,1,1,-1"; }), HasSubstr("sizes must be positive"));
  EXPECT_THAT(with([](auto& o) { o.size = -1.0; }), HasSubstr("size = -1"));
}

TEST(ReconstructOptions, BecomeWhatTheySay) {
  ReconstructOptions options;
  options.camera = "92.5x72.32:320x240";
  options.obstacles = "0,0,-1,4,4,0.1;1,1,1,0.2,0.2,0.2";
  options.workspace = "-3,-3,0,3,3,3";
  EXPECT_EQ(options.range_camera().resolution, (Resolution{320, 240}));
  EXPECT_NEAR(degrees(options.range_camera().horizontal_aperture()), 92.5, 1e-12);
  EXPECT_NEAR(degrees(options.range_camera().vertical_aperture()), 72.32, 1e-12);
  const ReachOptions reach = options.planner_options().reach;
  ASSERT_EQ(reach.obstacles.size(), 2U);
  EXPECT_TRUE(reach.obstacles[0].min().isApprox(Vec3(-2, -2, -1.05)));
  EXPECT_TRUE(reach.workspace->max().isApprox(Vec3(3, 3, 3)));
  EXPECT_EQ(options.scene_options().enclosure().min, Index3::Constant(75));
  EXPECT_EQ(options.scene_options().enclosure().max, Index3::Constant(129));
}

}  // namespace
}  // namespace vantage
