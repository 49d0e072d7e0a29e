#include "vantage/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace vantage {
namespace {

TEST(Random, SameSeedAndStreamGiveTheSameNumbers) {
  Random a(42, 3);
  Random b(42, 3);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.bits(), b.bits());
}

TEST(Random, SeedsAndStreamsDiffer) {
  Random plain(1);
  Random other_seed(2);
  Random other_stream(1, 1);
  Random swapped(0, 1);
  const std::uint64_t first = plain.bits();
  EXPECT_NE(first, other_seed.bits());
  EXPECT_NE(first, other_stream.bits());
  EXPECT_NE(first, swapped.bits());
}

TEST(Random, UniformStaysInItsRangeAndFillsIt) {
  Random random(5);
  double least = 1;
  double largest = 0;
  double sum = 0;
  for (int i = 0; i < 100000; ++i) {
    const double value = random.uniform();
    ASSERT_GE(value, 0);
    ASSERT_LT(value, 1);
    least = std::min(least, value);
    largest = std::max(largest, value);
    sum += value;
  }
  EXPECT_LT(least, 1e-3);
  EXPECT_GT(largest, 1 - 1e-3);
  EXPECT_NEAR(sum / 100000, 0.5, 5e-3);  // five standard deviations
}

TEST(Random, IndexHitsEveryValueEquallyOften) {
  Random random(6);
  std::array<int, 7> hits{};
  for (int i = 0; i < 70000; ++i) ++hits.at(static_cast<std::size_t>(random.index(7)));
  for (const int hit : hits) EXPECT_NEAR(hit, 10000, 500);
}

TEST(Random, NormalHasTheMomentsAndTailsOfTheNormalDistribution) {
  Random random(7);
  constexpr int count = 200000;
  double sum = 0;
  double squares = 0;
  double fourth_powers = 0;
  int beyond_two = 0;
  for (int i = 0; i < count; ++i) {
    const double value = random.normal();
    sum += value;
    squares += value * value;
    fourth_powers += value * value * value * value;
    if (std::abs(value) > 2) ++beyond_two;
  }
  EXPECT_NEAR(sum / count, 0, 0.012);
  EXPECT_NEAR(squares / count, 1, 0.016);
  EXPECT_NEAR(fourth_powers / count, 3, 0.11);
  EXPECT_NEAR(static_cast<double>(beyond_two) / count, std::erfc(std::sqrt(2.0)), 0.0024);
}

TEST(Random, NormalTakesTheLogarithmToTheLastBits) {
  // The polar method again with std::log, which is within one unit in the last place on every platform.
  Random random(8);
  Random twin(8);
  for (int i = 0; i < 10000; ++i) {
    double u = 0;
    double squared = 0;
    do {
      u = twin.uniform(-1, 1);
      const double v = twin.uniform(-1, 1);
      squared = u * u + v * v;
    } while (squared <= 0 || squared >= 1);
    const double expected = u * std::sqrt(-2 * std::log(squared) / squared);
    ASSERT_NEAR(random.normal(), expected, 1e-14 * std::max(1.0, std::abs(expected)));
  }
}

TEST(Random, NumbersAreTheSameOnEveryMachine) {
  Random random(2026);
  EXPECT_EQ(random.bits(), 7165608976312308233U);
  EXPECT_EQ(random.uniform(), 0x1.ff97b531449c8p-2);
  EXPECT_EQ(random.normal(), 0x1.f7bb1f5a4dd3p+0);
}

TEST(Random, UnitVectorsHaveLengthOneAndNoPreferredDirection) {
  Random random(9);
  Vec3 sum = Vec3::Zero();
  Mat3 spread = Mat3::Zero();
  constexpr int count = 30000;
  for (int i = 0; i < count; ++i) {
    const Vec3 direction = random.unit_vector();
    ASSERT_NEAR(direction.norm(), 1, 1e-14);
    sum += direction;
    spread += direction * direction.transpose();
  }
  EXPECT_LT((sum / count).norm(), 0.02);
  EXPECT_LT((spread / count - Mat3::Identity() / 3).cwiseAbs().maxCoeff(), 0.01);
}

}  // namespace
}  // namespace vantage
