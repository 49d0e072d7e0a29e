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
  const SensorModel noise = sensor_with({0.001, 0.002});
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
  EXPECT_TRUE(SensorModel{}.is_ideal());
  EXPECT_EQ(noisy(flat_image(1.25F), {}, random).depth, flat_image(1.25F).depth);
}

TEST(DepthNoise, QuantumRoundsToMultiples) {
  Random random(2);
  EXPECT_FLOAT_EQ(noisy(flat_image(1.013F), {.quantum = 0.005}, random).depth[7], 1.015F);
  const RangeImage image = noisy(flat_image(1.0F), {.constant = 0.004, .quantum = 0.005}, random);
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
  image = noisy(image, {.constant = 0.1, .dropout_from_incidence = radians(30)}, random);
  EXPECT_EQ(image.depth[3], RangeImage::no_return);
  EXPECT_EQ(image.depth[4], RangeImage::unknown);
  EXPECT_NE(image.depth[5], 1);
}

TEST(DepthNoise, DepthsBeyondTheLimitsBecomeUnknown) {
  RangeImage image = flat_image(1);
  image.camera.min_depth = 0.98;
  image.camera.max_depth = 1.01;
  Random random(4);
  image = noisy(image, {.constant = 0.01}, random);
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
  const SensorModel noise{.constant = 0.01, .quadratic = 0.001, .quantum = 0.001, .dropout_from_incidence = radians(5)};
  Random one(6), same(6), other(7);
  const auto first = noisy(flat_image(2), noise, one).depth;
  EXPECT_EQ(first, noisy(flat_image(2), noise, same).depth);
  EXPECT_NE(first, noisy(flat_image(2), noise, other).depth);
}

TEST(DepthNoise, SeedsGiveTheBitsThatTheyAlwaysGave) {
  // From the time when a noise was a + b z^2, a step and dropouts, and nothing else.
  Random random(8);
  RangeImage image = flat_image(2);
  image.depth[1] = 1.5F;
  const SensorModel noise{.constant = 0.01, .quadratic = 0.001};
  const RangeImage result = noisy(image, noise, random);
  Random same(8);
  EXPECT_EQ(result.depth[0], static_cast<float>(2.0 + (0.01 + 0.001 * 2.0 * 2.0) * same.normal()));
  EXPECT_EQ(result.depth[1], static_cast<float>(1.5 + (0.01 + 0.001 * 1.5 * 1.5) * same.normal()));
}

/// A near and a far plane, both seen frontally, with the edge between two columns.
RangeImage edge_image() {
  RangeImage image = flat_image(1);
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (i % 200 >= 100) image.depth[i] = 2;
  }
  return image;
}

std::vector<std::size_t> pixels_off_both_planes(const RangeImage& image) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (image.depth[i] != 1 && image.depth[i] != 2) found.push_back(i);
  }
  return found;
}

TEST(DepthNoise, MixedPixelsLieBetweenTheSurfacesOfAnEdge) {
  Random random(9);
  const RangeImage image = noisy(edge_image(), {.mixed = 0.5}, random);
  const std::vector<std::size_t> mixed = pixels_off_both_planes(image);
  // 400 pixels touch the edge; half of them, give or take four times 10.
  EXPECT_NEAR(static_cast<double>(mixed.size()), 200, 40);
  double sum = 0;
  for (const std::size_t pixel : mixed) {
    EXPECT_TRUE(pixel % 200 == 99 || pixel % 200 == 100) << pixel;
    EXPECT_GT(image.depth[pixel], 1);
    EXPECT_LT(image.depth[pixel], 2);
    sum += static_cast<double>(image.depth[pixel]);
  }
  EXPECT_NEAR(sum / static_cast<double>(mixed.size()), 1.5, 4 * 0.289 / std::sqrt(160)) << "evenly between them";
}

TEST(DepthNoise, LateralNoiseMovesEdgesAndNothingElse) {
  Random random(10);
  const RangeImage image = noisy(edge_image(), {.lateral = 0.8}, random);
  EXPECT_TRUE(pixels_off_both_planes(image).empty());
  int near_beyond = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    const std::size_t column = i % 200;
    if (column < 90 || column > 110) {
      EXPECT_EQ(image.depth[i], column < 90 ? 1 : 2);
    }
    if (column == 100 && image.depth[i] == 1) ++near_beyond;
  }
  // The pixel takes the surface to its left where the draw rounds to -1 or less: P(z < -0.5/0.8) = 0.266 of 200 rows.
  EXPECT_NEAR(near_beyond, 53, 25);
}

TEST(DepthNoise, EdgesBesideNothingStayDepths) {
  // Lateral noise puts the box where nothing is, two pixels from its nearest neighbour: nothing to mix with.
  RangeImage image = flat_image(RangeImage::no_return);
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (i % 200 >= 80 && i % 200 < 120 && i / 200 >= 80 && i / 200 < 120) image.depth[i] = 1;
  }
  Random random(13);
  image = noisy(image, {.lateral = 3, .mixed = 1}, random);
  EXPECT_NO_THROW(image.validate());
  EXPECT_TRUE(std::all_of(image.depth.begin(), image.depth.end(),
                          [](float depth) { return depth == 1 || depth == RangeImage::no_return; }));
}

TEST(DepthNoise, NoiseGrowsWithIncidence) {
  // A plane that the middle rays meet under 60 degrees: tan^2 = 3.
  RangeImage image = flat_image(1);
  const RayGrid rays = image.camera.rays();
  const double slope = std::tan(radians(60));
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    image.depth[i] = static_cast<float>(1 / (1 - slope * rays.y(static_cast<int>(i / 200))));
  }
  Random random(11);
  const RangeImage result = noisy(image, {.incidence = 0.001}, random);
  std::vector<float> errors;
  for (std::size_t i = 98 * 200; i < 102 * 200; ++i) {
    if (i % 200 >= 50 && i % 200 < 150) errors.push_back(result.depth[i] - image.depth[i]);
  }
  // 400 pixels: the deviation scatters by a 28th; tan^2 itself varies by a tenth across these pixels.
  EXPECT_NEAR(spread_of(errors).deviation, 0.003, 0.0007);
}

TEST(DepthNoise, AnyPixelMayDropOut) {
  Random random(12);
  const RangeImage image = noisy(flat_image(1), {.dropout = 0.1}, random);
  const auto lost = std::count(image.depth.begin(), image.depth.end(), RangeImage::unknown);
  EXPECT_NEAR(static_cast<double>(lost), 4000, 240);  // four times 60
}

}  // namespace
}  // namespace vantage
