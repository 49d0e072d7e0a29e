#include "vantage/search/convolution.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

/// Eq. 20 as printed, for the expected utility: all pairs of candidates, eq. 19 with A = 1 by the inverse covariance.
std::vector<double> naive(const std::vector<double>& g, const Candidates& candidates, const PositioningError& error) {
  const Mat3 inverse = error.covariance.inverse();
  std::vector<double> result(g.size(), 0.0);
  for (std::size_t v = 0; v < g.size(); ++v) {
    for (std::size_t u = 0; u < g.size(); ++u) {
      const Vec3 x = candidates.views[u].position() - candidates.views[v].position() - error.mean;
      result[v] += std::exp(-0.5 * x.dot(inverse * x)) * g[u];
    }
  }
  return result;
}

std::vector<double> random_utilities(std::size_t count, Random& random) {
  std::vector<double> values(count);
  for (double& value : values) value = random.uniform() < 0.1 ? 0 : random.uniform(0, 3);
  return values;
}

void expect_near(const std::vector<double>& ours, const std::vector<double>& expected) {
  ASSERT_EQ(ours.size(), expected.size());
  for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(ours[i], expected[i], 1e-9 * (1 + expected[i])) << i;
}

TEST(Convolution, SeparablePassesAreEquation20) {
  Random random(3);
  for (int i = 0; i < 10; ++i) {
    const Candidates cube = view_cube(9, Vec3(4, 3, 5), 0.8, 2.2, Vec3(0.1, 0.2, 0.3));
    PositioningError error = PositioningError::from_deviations(
        Vec3(random.uniform(0.05, 0.6), random.uniform(0.05, 0.6), random.uniform(0.05, 0.6)));
    if (i % 2 == 1) error.mean = 0.2 * random.normal3();
    const std::vector<double> g = random_utilities(cube.views.size(), random);
    expect_near(convolve(g, cube, error), naive(g, cube, error));
  }
}

TEST(Convolution, FullCovarianceIsEquation20) {
  Random random(4);
  for (int i = 0; i < 10; ++i) {
    const Candidates cube = view_cube(8, Vec3::Constant(4), 0.8, 2.2, Vec3::Zero());
    PositioningError error;
    Mat3 root;
    for (int a = 0; a < 3; ++a) root.col(a) = 0.3 * random.normal3();
    error.covariance = root * root.transpose() + 0.01 * Mat3::Identity();
    error.mean = 0.1 * random.normal3();
    const std::vector<double> g = random_utilities(cube.views.size(), random);
    expect_near(convolve(g, cube, error), naive(g, cube, error));
  }
}

TEST(Convolution, MovesAPeakAgainstTheMeanError) {
  // The robot always ends one cell too far along +x: the view to command lies one cell before the good one.
  const Candidates cube = view_cube(5, Vec3::Constant(5), 0.5, 10, Vec3::Zero());
  std::vector<double> g(cube.views.size(), 0.0);
  const auto index_of = [&](const Index3& cell) {
    const auto& cells = cube.grid->cell_of_view;
    return static_cast<std::size_t>(std::find(cells.begin(), cells.end(), cell) - cells.begin());
  };
  g[index_of({3, 1, 1})] = 1;
  PositioningError error;
  error.mean = Vec3(1, 0, 0);
  const std::vector<double> expected = convolve(g, cube, error);
  EXPECT_DOUBLE_EQ(expected[index_of({2, 1, 1})], 1);
  EXPECT_DOUBLE_EQ(expected[index_of({3, 1, 1})], 0);
}

TEST(Convolution, ByHandOnALine) {
  // sigma = one cell along x only: a lone 1 spreads as exp(-m^2/2).
  const Candidates cube = view_cube(5, Vec3::Constant(5), 0.5, 10, Vec3::Zero());
  std::vector<double> g(cube.views.size(), 0.0);
  for (std::size_t i = 0; i < g.size(); ++i) {
    if (cube.grid->cell_of_view[i] == Index3(2, 0, 0)) g[i] = 1;
  }
  const std::vector<double> result = convolve(g, cube, PositioningError::from_deviations(Vec3(1, 0, 0)));
  for (std::size_t i = 0; i < g.size(); ++i) {
    const Index3& cell = cube.grid->cell_of_view[i];
    const double expected = cell.y() == 0 && cell.z() == 0 ? std::exp(-0.5 * (cell.x() - 2) * (cell.x() - 2)) : 0;
    EXPECT_NEAR(result[i], expected, 1e-15);
  }
}

TEST(Convolution, NormalisedConstantStaysConstantInTheMiddle) {
  const Candidates cube = view_cube(15, Vec3::Constant(15), 0.5, 100, Vec3::Zero());
  const std::vector<double> g(cube.views.size(), 2.0);
  ConvolutionOptions options;
  options.normalise = true;
  const std::vector<double> result = convolve(g, cube, PositioningError::from_deviations(Vec3::Constant(0.8)), options);
  for (std::size_t i = 0; i < g.size(); ++i) {
    const Index3& cell = cube.grid->cell_of_view[i];
    if (cell == Index3(7, 1, 7)) {
      EXPECT_LT(result[i], 2.0) << "near the border cells are missing";
    }
    if (cell == Index3(11, 7, 7)) {
      EXPECT_NEAR(result[i], 2.0, 0.01);
    }
  }
}

TEST(Convolution, TruncationLeavesOutTheTails) {
  const Candidates cube = view_cube(7, Vec3::Constant(7), 0.5, 100, Vec3::Zero());
  std::vector<double> g(cube.views.size(), 0.0);
  for (std::size_t i = 0; i < g.size(); ++i) g[i] = cube.grid->cell_of_view[i] == Index3(0, 0, 0) ? 1 : 0;
  ConvolutionOptions options;
  options.truncate_sigmas = 2.5;
  const std::vector<double> result = convolve(g, cube, PositioningError::from_deviations(Vec3::Constant(1)), options);
  for (std::size_t i = 0; i < g.size(); ++i) {
    const Index3& cell = cube.grid->cell_of_view[i];
    EXPECT_EQ(result[i] > 0, cell.maxCoeff() <= 2) << cell.transpose();
  }
}

TEST(Convolution, OffTheGridAveragesOverTheNeighbours) {
  const Candidates sphere = view_sphere(80, 2, Vec3::Zero());
  Random random(9);
  const std::vector<double> g = random_utilities(80, random);
  const double sigma = 0.4;
  const std::vector<double> result = convolve(g, sphere, PositioningError::from_deviations(Vec3::Constant(sigma)));
  int left_out = 0;
  for (std::size_t v = 0; v < g.size(); ++v) {
    double sum = 0;
    double weights = 0;
    for (std::size_t u = 0; u < g.size(); ++u) {
      const double distance = (sphere.views[u].position() - sphere.views[v].position()).norm() / sigma;
      left_out += distance > 4 ? 1 : 0;
      if (distance > 4) continue;
      sum += std::exp(-0.5 * distance * distance) * g[u];
      weights += std::exp(-0.5 * distance * distance);
    }
    EXPECT_NEAR(result[v], sum / weights, 1e-12);
  }
  EXPECT_GT(left_out, 1000);
}

TEST(Convolution, WithAnErrorPerCandidateIsTheNormalisedOneWhereTheyAreAlike) {
  Random random(12);
  for (const bool grid : {true, false}) {
    const Candidates candidates =
        grid ? view_cube(7, Vec3(4, 3, 5), 0.3, 10, Vec3::Zero()) : view_sphere(80, 2, Vec3::Zero());
    PositioningError error;
    Mat3 root;
    for (int a = 0; a < 3; ++a) root.col(a) = 0.15 * random.normal3();
    error.covariance = root * root.transpose() + 0.02 * Mat3::Identity();
    error.mean = {0.05, -0.1, 0};
    const std::vector<double> g = random_utilities(candidates.views.size(), random);
    ConvolutionOptions options;
    options.normalise = true;
    const std::vector<PositioningError> errors(g.size(), error);
    const std::vector<double> ours = convolve_each(g, candidates, errors, options);
    const std::vector<double> expected = convolve(g, candidates, error, options);
    for (std::size_t i = 0; i < g.size(); ++i) EXPECT_NEAR(ours[i], expected[i], 1e-6) << i;
  }
}

TEST(Convolution, TrustsACandidateWhereTheRobotIsGood) {
  const Candidates cube = view_cube(5, Vec3::Constant(5), 0.5, 10, Vec3::Zero());
  Random random(13);
  const std::vector<double> g = random_utilities(cube.views.size(), random);
  std::vector<PositioningError> errors(g.size(), PositioningError::from_deviations(Vec3::Constant(1)));
  errors[3] = {};
  const std::vector<double> result = convolve_each(g, cube, errors);
  EXPECT_EQ(result[3], g[3]);
  int changed = 0;
  for (std::size_t i = 0; i < g.size(); ++i) changed += std::abs(result[i] - g[i]) > 1e-3 ? 1 : 0;
  EXPECT_GT(changed, 100);
  EXPECT_THROW((void)convolve_each(g, cube, std::vector<PositioningError>(3)), InputError);
}

TEST(Convolution, WithoutErrorChangesNothing) {
  const Candidates sphere = view_sphere(20, 2, Vec3::Zero());
  Random random(2);
  const std::vector<double> g = random_utilities(20, random);
  EXPECT_EQ(convolve(g, sphere, {}), g);
}

TEST(PositioningError, NamesTheBadValue) {
  EXPECT_THROW((void)PositioningError::from_deviations(Vec3(0.1, -0.1, 0)), InputError);
  PositioningError error;
  error.covariance = Vec3(1, 1, -0.5).asDiagonal();
  EXPECT_THROW(error.validate(), InputError);
  error.covariance << 1, 2, 0, 2, 1, 0, 0, 0, 1;  // eigenvalue -1
  EXPECT_THROW(error.validate(), InputError);
  error.covariance << 1, 2, 0, 0, 1, 0, 0, 0, 1;
  EXPECT_THROW(error.validate(), InputError);
}

TEST(Convolution, RefusesKernelsThatDoNotFitInMemory) {
  Candidates wide;
  wide.kind = Candidates::Kind::grid;
  wide.views = {View{}};
  wide.grid = CandidateGrid{300, Vec3::Constant(0.01), {Index3::Zero()}};
  PositioningError tilted = PositioningError::from_deviations(Vec3(0.02, 0.02, 0.02));
  tilted.covariance(0, 1) = tilted.covariance(1, 0) = 1e-4;
  const std::vector<double> one{1.0};
  EXPECT_THROW((void)convolve(one, wide, tilted), InputError);
  const std::vector<PositioningError> far{PositioningError::from_deviations(Vec3(5, 5, 5))};
  EXPECT_THROW((void)convolve_each(one, wide, far), InputError);
  wide.grid->cells_per_side = 3;
  EXPECT_NO_THROW((void)convolve(one, wide, tilted));
}

}  // namespace
}  // namespace vantage
