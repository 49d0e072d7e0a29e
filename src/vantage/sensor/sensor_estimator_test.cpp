#include "vantage/sensor/sensor_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/random.hpp"

namespace vantage {
namespace {

/// A plane at about `depth`, tilted, its upper half too bumpy to be one, and noise of a + b z^2 in steps of `quantum`.
RangeImage image_at(double depth, const DepthDeviation& noise, double quantum, Random& random) {
  RangeImage image{camera_from_apertures(radians(40), radians(30), {160, 120}), {}};
  const RayGrid rays = image.camera.rays();
  for (int row = 0; row < 120; ++row) {
    for (int column = 0; column < 160; ++column) {
      const double z = depth / (1 - 0.5 * rays.x(column));
      const double bumps = row < 60 ? 0.02 * std::sin(column) * std::sin(1.3 * row) : 0;
      double measured = z + bumps + (noise.a + noise.b * z * z) * random.normal();
      if (quantum > 0) measured = std::round(measured / quantum) * quantum;
      image.depth.push_back(static_cast<float>(measured));
    }
  }
  return image;
}

TEST(SensorEstimator, FindsTheDeviationAmongBumps) {
  const DepthDeviation truth{0.0005, 0.002};
  for (const double quantum : {0.0, 0.001}) {
    Random random(1);
    SensorEstimator estimator;
    for (const double depth : {0.4, 0.6, 0.9, 1.3, 2.0}) estimator.add(image_at(depth, truth, quantum, random));
    const auto found = estimator.estimate();
    ASSERT_TRUE(found);
    EXPECT_GT(estimator.windows(), 1000);
    for (const double depth : {0.5, 1.0, 2.0}) {
      // Half of the windows are bumpy, so that the tenth is the fifth of the rest: some hundredths more than there is.
      EXPECT_NEAR(found->noise(depth) / sensor_with(truth).noise(depth), 1, 0.12) << depth << " m, quantum " << quantum;
    }
    EXPECT_NEAR(found->quantum, quantum, 1e-5);
  }
}

TEST(SensorEstimator, OneDepthGivesOneDeviation) {
  Random random(2);
  SensorEstimator estimator;
  RangeImage image{camera_from_apertures(radians(10), radians(10), {100, 100}), {}};
  for (int i = 0; i < 10000; ++i) image.depth.push_back(static_cast<float>(1 + 0.003 * random.normal()));
  estimator.add(image);
  ASSERT_TRUE(estimator.estimate());
  EXPECT_NEAR(estimator.estimate()->noise(1), 0.003, 0.0003);
}

TEST(SensorEstimator, SaysNothingWithoutSurfaces) {
  SensorEstimator estimator;
  EXPECT_FALSE(estimator.estimate());
  RangeImage image{camera_from_apertures(radians(10), radians(10), {100, 100}), {}};
  image.depth.assign(10000, RangeImage::no_return);
  estimator.add(image);
  EXPECT_FALSE(estimator.estimate());
  EXPECT_EQ(estimator.windows(), 0);
}

}  // namespace
}  // namespace vantage
