#include "vantage/robot/box_tree.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "vantage/core/random.hpp"

namespace vantage {
namespace {

TEST(BoxTree, TellsWhatAllBoxesAskedOneByOneTell) {
  Random random(3);
  int inside = 0;
  int outside = 0;
  for (int scene = 0; scene < 50; ++scene) {
    std::vector<Box3> boxes;
    for (int i = random.index(60); i > 0; --i) {
      const Vec3 corner = random.normal3();
      boxes.emplace_back(corner, corner + Vec3(random.uniform(), random.uniform(), random.uniform()));
    }
    const BoxTree tree(boxes);
    for (int i = 0; i < 40; ++i) {
      const Vec3 point = random.uniform(0.2, 2) * random.normal3();
      double nearest = std::numeric_limits<double>::infinity();
      for (const Box3& box : boxes) nearest = std::min(nearest, box.exteriorDistance(point));
      EXPECT_EQ(tree.distance(point), nearest);
      (nearest == 0 ? inside : outside) += 1;
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 1000);
  EXPECT_EQ(BoxTree({}).distance(Vec3::Zero()), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace vantage
