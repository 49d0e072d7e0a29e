#include "vantage/map/grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Grid, PointsInsideOnPlanesAndOutside) {
  const Grid grid{Vec3(-1, 0, 1), 0.25, Index3(8, 4, 4)};
  EXPECT_EQ(grid.index_of(Vec3(-1, 0, 1)), Index3(0, 0, 0)) << "the lower face belongs to the voxel";
  EXPECT_EQ(grid.index_of(Vec3(-0.75, 0.1, 1.3)), Index3(1, 0, 1));
  EXPECT_EQ(grid.index_of(Vec3(-1.01, -0.26, 9)), Index3(-1, -2, 32)) << "the lattice goes on outside";
  EXPECT_EQ(grid.center({1, 0, 3}), Vec3(-0.625, 0.125, 1.875));
  EXPECT_EQ(grid.box({Index3(1, 0, 0), Index3(2, 0, 3)}).min(), Vec3(-0.75, 0, 1));
  EXPECT_EQ(grid.box({Index3(1, 0, 0), Index3(2, 0, 3)}).max(), Vec3(-0.25, 0.25, 2));
}

TEST(Grid, APointOnAPlaneBelongsToTheUpperVoxelWhateverTheRounding) {
  Random random(31);
  int points = 0;
  for (int i = 0; i < 2000; ++i) {
    const Grid grid{random.normal3(), random.uniform(0.001, 0.1), Index3(9, 9, 9)};
    const int axis = random.index(3);
    const int k = random.index(400) - 200;
    const double plane = grid.plane(axis, k);
    ASSERT_EQ(grid.index_of(axis, plane), k);
    ASSERT_EQ(grid.index_of(axis, std::nextafter(plane, -1e9)), k - 1);
    ASSERT_EQ(grid.index_of(axis, std::nextafter(plane, 1e9)), k);
    ++points;
  }
  EXPECT_EQ(points, 2000);
}

TEST(Grid, PlanesEncloseEveryPoint) {
  Random random(32);
  for (int i = 0; i < 2000; ++i) {
    const Grid grid{1000 * random.normal3(), 0.02, Index3(9, 9, 9)};
    const Vec3 point = grid.min + 10 * random.normal3();
    const Index3 index = grid.index_of(point);
    for (int a = 0; a < 3; ++a) {
      ASSERT_LE(grid.plane(a, index[a]), point[a]);
      ASSERT_GT(grid.plane(a, index[a] + 1), point[a]);
    }
  }
}

TEST(Grid, PointsFartherThanIndicesReachAreClamped) {
  const Grid grid{Vec3::Zero(), 0.02, Index3(9, 9, 9)};
  EXPECT_EQ(grid.index_of(0, 1e30), Grid::farthest_index);
  EXPECT_EQ(grid.index_of(0, -1e30), -Grid::farthest_index);
  EXPECT_EQ(grid.index_of(0, std::numeric_limits<double>::infinity()), Grid::farthest_index);
}

TEST(SceneOptions, ThePapersScene) {
  const SceneOptions options;
  EXPECT_NO_THROW(options.validate());
  EXPECT_TRUE(options.grid().min.isApproxToConstant(-2.05));
  EXPECT_EQ(options.enclosure().min, Index3::Constant(75));
  EXPECT_EQ(options.enclosure().max, Index3::Constant(129));
  EXPECT_LT(options.grid().box(options.enclosure()).center().norm(), 1e-12);
}

TEST(SceneOptions, ErrorsNameTheField) {
  const auto broken = [](auto change) {
    SceneOptions options;
    change(options);
    return [options] { options.validate(); };
  };
  using Options = SceneOptions;
  EXPECT_THAT(broken([](Options& o) { o.voxel_length = 0; }), ThrowsMessage<InputError>(HasSubstr("voxel length = 0")));
  EXPECT_THAT(broken([](Options& o) { o.voxel_length = 1e-9; }), ThrowsMessage<InputError>(HasSubstr("1e-6")));
  EXPECT_THAT(broken([](Options& o) { o.scene_size.y() = 0; }), ThrowsMessage<InputError>(HasSubstr("scene size")));
  EXPECT_THAT(broken([](Options& o) { o.scene_size.y() = 99999; }), ThrowsMessage<InputError>(HasSubstr("16384")));
  EXPECT_THAT(broken([](Options& o) { o.center.x() = NAN; }), ThrowsMessage<InputError>(HasSubstr("finite")));
  EXPECT_THAT(broken([](Options& o) { o.center.x() = 1e7; }), ThrowsMessage<InputError>(HasSubstr("metres?")));
  EXPECT_THAT(broken([](Options& o) { o.enclosure_size.z() = 0; }),
              ThrowsMessage<InputError>(HasSubstr("enclosure size")));
  EXPECT_THAT(broken([](Options& o) { o.enclosure_size.z() = 206; }), ThrowsMessage<InputError>(HasSubstr("must fit")));
}

}  // namespace
}  // namespace vantage
