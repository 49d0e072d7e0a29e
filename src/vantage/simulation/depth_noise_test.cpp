#include "vantage/simulation/depth_noise.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

RangeImage flat_image(float depth) {
  RangeImage image;
  image.camera = camera_from_apertures(radians(45), radians(45), {200, 200});
  image.depth.assign(200 * 200, depth);
  return image;
}

struct Spread {
  double mean = 0, deviation = 0;
};

Spread spread_of(const std::vector<float>& values) {
  double sum = 0, squares = 0;
  for (const float value : values) sum += static_cast<double>(value);
  const double mean = sum / static_cast<double>(values.size());
  for (const float value : values) squares += std::pow(static_cast<double>(value) - mean, 2);
  return {mean, std::sqrt(squares / static_cast<double>(values.size()))};
}

TEST(DepthNoise, DeviationGrowsWithTheSquareOfTheDepth) {
  const DepthNoise noise{.a = 0.001, .b = 0.002};
  Random random(1);
  // 40,000 pixels: the mean scatters by sigma/200, the deviation by sigma/283; limits at four times that.
  for (const double depth : {0.5, 1.0, 3.0}) {
    const double sigma = 0.001 + 0.002 * depth * depth;
    const Spread spread = spread_of(noisy(flat_image(static_cast<float>(depth)), noise, random).depth);
    EXPECT_NEAR(spread.mean, depth, 4 * sigma / 200) << depth;
    EXPECT_NEAR(spread.deviation, sigma, 4 * sigma / 283) << depth;
  }
}

TEST(DepthNoise, NoneChangesNothing) {
  Random random(1);
  EXPECT_TRUE(DepthNoise{}.is_none());
  EXPECT_EQ(noisy(flat_image(1.25F), {}, random).depth, flat_image(1.25F).depth);
}

TEST(DepthNoise, QuantumRoundsToMultiples) {
  Random random(2);
  EXPECT_FLOAT_EQ(noisy(flat_image(1.013F), {.quantum = 0.005}, random).depth[7], 1.015F);
  const RangeImage image = noisy(flat_image(1.0F), {.a = 0.004, .quantum = 0.005}, random);
  const auto [low, high] = std::minmax_element(image.depth.begin(), image.depth.end());
  EXPECT_LT(*low, 0.99F);
  EXPECT_GT(*high, 1.01F);
  for (const float depth : image.depth) {
    const double steps = static_cast<double>(depth) / 0.005;
    ASSERT_NEAR(steps, std::round(steps), 1e-4);
  }
}

TEST(DepthNoise, LeavesPixelsWithoutASurfaceAlone) {
  RangeImage image = flat_image(1);
  image.depth[3] = RangeImage::no_return;
  image.depth[4] = RangeImage::unknown;
  Random random(3);
  image = noisy(image, {.a = 0.1, .dropout_from_incidence = radians(30)}, random);
  EXPECT_EQ(image.depth[3], RangeImage::no_return);
  EXPECT_EQ(image.depth[4], RangeImage::unknown);
  EXPECT_NE(image.depth[5], 1);
}

TEST(DepthNoise, DepthsBeyondTheLimitsBecomeUnknown) {
  RangeImage image = flat_image(1);
  image.camera.min_depth = 0.98;
  image.camera.max_depth = 1.01;
  Random random(4);
  image = noisy(image, {.a = 0.01}, random);
  const auto lost = std::count(image.depth.begin(), image.depth.end(), RangeImage::unknown);
  // P(z < -2) + P(z > 1) = 0.1814 of 40,000 pixels, give or take four times 77.
  EXPECT_NEAR(static_cast<double>(lost), 7256, 310);
  for (const float depth : image.depth) {
    ASSERT_TRUE(depth == RangeImage::unknown || (depth >= 0.98F && depth <= 1.01F)) << depth;
  }
}

TEST(DepthNoise, DropoutsGrowWithIncidence) {
  // A plane that all rays of one row meet under nearly the same angle: z = 1 + y tan(60 degrees).
  RangeImage image = flat_image(1);
  const RayGrid rays = image.camera.rays();
  const double slope = std::tan(radians(60));
  for (int row = 0; row < 200; ++row) {
    for (int column = 0; column < 200; ++column) {
      image.depth[static_cast<std::size_t>(row * 200 + column)] = static_cast<float>(1 / (1 - slope * rays.y(row)));
    }
  }
  const auto lost_share_of_middle_rows = [&](double from) {
    Random random(5);
    const RangeImage result = noisy(image, {.dropout_from_incidence = from}, random);
    const auto first = result.depth.begin() + 90 * 200;
    return static_cast<double>(std::count(first, first + 20 * 200, RangeImage::unknown)) / (20 * 200);
  };
  // Incidence there: 60 degrees, up to 4 less and more in the corners. 4,000 pixels scatter by 0.008.
  EXPECT_NEAR(lost_share_of_middle_rows(radians(30)), 0.5, 0.06);
  EXPECT_NEAR(lost_share_of_middle_rows(radians(45)), 1.0 / 3, 0.06);
  EXPECT_EQ(lost_share_of_middle_rows(radians(75)), 0);
}

TEST(DepthNoise, SameSeedSameBits) {
  const DepthNoise noise{.a = 0.01, .b = 0.001, .quantum = 0.001, .dropout_from_incidence = radians(5)};
  Random one(6), same(6), other(7);
  const auto first = noisy(flat_image(2), noise, one).depth;
  EXPECT_EQ(first, noisy(flat_image(2), noise, same).depth);
  EXPECT_NE(first, noisy(flat_image(2), noise, other).depth);
}

TEST(DepthNoise, NamesWhatIsWrong) {
  const auto complaint = [](const DepthNoise& noise) -> std::string {
    try {
      noise.validate();
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_THAT(complaint({.a = -0.1}), HasSubstr("a = -0.1 m: must not be negative"));
  EXPECT_THAT(complaint({.b = -2}), HasSubstr("b = -2 1/m"));
  EXPECT_THAT(complaint({.quantum = -1}), HasSubstr("quantum = -1 m"));
  EXPECT_THAT(complaint({.dropout_from_incidence = radians(90)}), HasSubstr("dropout_from_incidence = 90 degrees"));
}

}  // namespace
}  // namespace vantage
