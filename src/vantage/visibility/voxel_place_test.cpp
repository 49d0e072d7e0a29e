#include "vantage/visibility/voxel_place.hpp"

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(VoxelPlace, PlacesNumberTheVoxelsOfTheLargestEnclosuresWithoutGaps) {
  const auto layout_of = [](const Index3& size) { return BitLayout{size, (size.x() + 63) / 64}; };
  std::uint32_t next = 0;
  const BitLayout small = layout_of({3, 4, 5});
  for (int z = 0; z < 5; ++z) {
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 3; ++x, ++next) {
        EXPECT_EQ(place_of(small, {x, y, z}), next);
        EXPECT_EQ(voxel_at(small, next), Index3(x, y, z));
      }
    }
  }
  for (const Index3& size : {Index3(16384, 16384, 8), Index3(8, 16384, 16384), Index3(1290, 1290, 1290)}) {
    ASSERT_LE(size.cast<std::int64_t>().prod(), std::int64_t{1} << 31);
    const Index3 last = size - Index3::Ones();
    EXPECT_EQ(place_of(layout_of(size), last), size.cast<std::int64_t>().prod() - 1);
    EXPECT_EQ(voxel_at(layout_of(size), place_of(layout_of(size), last)), last);
  }
}

}  // namespace
}  // namespace vantage
