#include "vantage/search/expected_utility.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"
#include "vantage/search/pose_samples.hpp"
#include "vantage/utility/gain.hpp"

namespace vantage {
namespace {

/// A half known ball: its upper part is occupied, below it lies what is not known.
VoxelMap half_known_ball() {
  SceneOptions scene;
  scene.voxel_length = 0.1;
  scene.scene_size = Index3::Constant(41);
  scene.enclosure_size = Index3::Constant(11);
  VoxelMap map(scene);
  const IndexBox box = map.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        const Vec3 place = map.grid().center({x, y, z});
        if (place.norm() > 0.45) {
          map.set_label({x, y, z}, Label::empty);
        } else if (place.norm() > 0.35 && place.z() > 0.1) {
          map.add_point({x, y, z}, place.normalized().cast<float>().cast<double>(), 1);
        } else {
          map.set_label({x, y, z}, Label::occluded);
        }
      }
    }
  }
  map.update_occplane();
  return map;
}

class ExpectedUtility : public testing::Test {
 protected:
  [[nodiscard]] ViewEvaluation problem(const Candidates& candidates) const {
    return {map,     visibility, camera, candidates, map.grid().length, Travel{}, candidates.views.front(),
            options, utility};
  }
  [[nodiscard]] std::vector<Evaluation> evaluate_all(const ViewEvaluation& asked) const {
    std::vector<int> all(asked.candidates.views.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    return asked.evaluate(all, std::vector<Resolution>(all.size(), camera.resolution));
  }

  VoxelMap map = half_known_ball();
  VisibilityEvaluator visibility{map};
  RangeCamera camera = camera_from_apertures(radians(45), radians(45), {40, 40});
  UtilityOptions options{.navigation = false};
  Utility utility{.score = CountUtility([](const Visibility&, const Factors& f) { return combined_utility(f); })};
};

TEST_F(ExpectedUtility, OfAUtilityThatComparesViewsIsWhatThePoseIsWorthAmongTheCandidates) {
  const Candidates sphere = view_sphere(20, 2, Vec3::Zero());
  ViewEvaluation asked = problem(sphere);
  asked.utility = gain_utility();
  const std::vector<Evaluation> evaluations = evaluate_all(asked);
  std::vector<int> feasible;
  std::vector<std::vector<PossiblePose>> sets;
  for (int v = 0; v < 20; ++v) feasible.push_back(v);
  for (const int v : {3, 0, 11}) sets.push_back({{sphere.views[static_cast<std::size_t>(v)], 1, true}});
  asked.feasible = feasible;
  const std::vector<Expectation> expected =
      expect(asked, sets, std::vector<Resolution>(sets.size(), camera.resolution), 0.1);
  EXPECT_EQ(expected[0].utility, evaluations[3].utility);
  EXPECT_EQ(expected[1].utility, evaluations[0].utility);
  EXPECT_EQ(expected[2].utility, evaluations[11].utility);
  EXPECT_GT(expected[0].utility + expected[1].utility + expected[2].utility, 0);
}

TEST_F(ExpectedUtility, OfTheCellsAroundACandidateIsConvolutionAfterEvaluation) {
  // The special case: a position-only error, the cells of the view cube as poses, eq. 19 as weights, the sensor turned
  // to the center wherever it ends up, cells without a candidate worth nothing. This is eq. 20 to the last digits.
  const Candidates cube = view_cube(7, Vec3::Constant(4.1), 0.82, 1.9, Vec3::Zero());
  const ViewEvaluation asked = problem(cube);
  PositioningError error = PositioningError::from_deviations({0.3, 0.5, 0.4});
  error.covariance(0, 1) = error.covariance(1, 0) = 0.05;
  error.mean = {0.1, 0, -0.2};
  const ErrorDensity eq19(error, Vec3::Constant(1e-9));
  std::vector<std::vector<PossiblePose>> sets;
  for (std::size_t v = 0; v < cube.views.size(); ++v) {
    std::vector<PossiblePose> cells;
    for (std::size_t u = 0; u < cube.views.size(); ++u) {
      cells.push_back({cube.views[u], eq19(cube.views[u].position() - cube.views[v].position()), true});
    }
    sets.push_back(std::move(cells));
  }
  const std::vector<Expectation> expected =
      expect(asked, sets, std::vector<Resolution>(sets.size(), camera.resolution), 0.1);
  std::vector<double> utilities;
  for (const Evaluation& each : evaluate_all(asked)) utilities.push_back(each.utility);
  const std::vector<double> convolved = convolve(utilities, cube, error);
  double largest = 0;
  for (std::size_t v = 0; v < cube.views.size(); ++v) {
    EXPECT_NEAR(expected[v].utility, convolved[v], 1e-9 * (1 + convolved[v])) << v;
    largest = std::max(largest, convolved[v]);
  }
  EXPECT_GT(largest, 0.5) << "there is something to see";
}

TEST_F(ExpectedUtility, IsTheMeanThatManyRandomPosesGive) {
  // The slow twin: exact rays from poses that are drawn at random, position and orientation.
  const Candidates sphere = view_sphere(20, 2, Vec3::Zero());
  const PoseError error = PoseError::from_deviations(Vec3::Constant(0.1), Vec3::Constant(radians(6)));
  const ConstantError model(error);
  const ReachOptions reach;
  ExpectationOptions expectation;
  expectation.candidates = 2;
  expectation.samples = 256;
  const ViewEvaluation asked = problem(sphere);
  std::vector<Evaluation> ranked = evaluate_all(asked);
  rank(ranked);
  // The overlap of a view without error: some poses around it overlap more, some less.
  const double least_overlap = expectation.least_overlap = ranked.front().factors.x_oc;
  ranked = rank_by_samples(asked, ranked, {model, map, reach}, expectation);
  ASSERT_EQ(ranked.size(), 2U);
  Random random(17);
  int between = 0;
  for (const Evaluation& each : ranked) {
    constexpr int draws = 500;
    double sum = 0;
    double squares = 0;
    double registers = 0;
    for (int i = 0; i < draws; ++i) {
      PoseError::Vector drawn;
      drawn << 0.1 * random.normal3(), radians(6) * random.normal3();
      const View view = displaced(each.view, drawn);
      const Visibility seen = see_exactly(map, camera, view, camera.resolution);
      const double worth =
          combined_utility(factors(seen, Travel{}.normalised(asked.current.position(), view.position()), options));
      const double all = seen.occupied + seen.occplane + seen.unmarked;
      sum += worth / draws;
      squares += worth * worth / draws;
      registers += all > 0 && seen.occupied / all >= least_overlap ? 1.0 / draws : 0;
    }
    const double standard_error = std::sqrt((squares - sum * sum) / draws);
    // Half of the allowance is for the 256 samples themselves.
    EXPECT_NEAR(each.expected->utility, sum, 6 * standard_error) << each.candidate;
    EXPECT_NEAR(each.expected->registers, registers, 0.08) << each.candidate;
    EXPECT_EQ(each.expected->samples, 256);
    EXPECT_EQ(each.score, each.expected->utility);
    EXPECT_GT(standard_error, 0);
    between += registers > 0.05 && registers < 0.95 ? 1 : 0;
  }
  EXPECT_GE(between, 1) << "some scan is neither sure to register nor sure not to";
}

TEST_F(ExpectedUtility, CountsPosesOutOfReachAsWorthless) {
  const Candidates sphere = view_sphere(20, 2, Vec3::Zero());
  const ConstantError model(PositioningError::from_deviations({0, 0, 0.1}));
  const ViewEvaluation asked = problem(sphere);
  std::vector<Evaluation> ranked = evaluate_all(asked);
  rank(ranked);
  ranked.resize(1);
  const double z = ranked[0].view.position().z();
  ReachOptions limited;
  limited.workspace = Box3(Vec3(-3, -3, z), Vec3(3, 3, 3));
  ExpectationOptions expectation;
  expectation.least_overlap = 0;
  const auto free = rank_by_samples(asked, ranked, {model, map, {}}, expectation);
  const auto half = rank_by_samples(asked, ranked, {model, map, limited}, expectation);
  EXPECT_NEAR(free[0].expected->registers, 1, 1e-12);
  EXPECT_NEAR(half[0].expected->registers, 0.5, 1e-12) << "the samples come in pairs around the middle";
  EXPECT_LT(half[0].expected->utility, 0.6 * free[0].expected->utility);
}

TEST_F(ExpectedUtility, OfARobotWithoutErrorIsTheUtility) {
  const Candidates sphere = view_sphere(20, 2, Vec3::Zero());
  const ConstantError model{PoseError()};
  std::vector<Evaluation> ranked = evaluate_all(problem(sphere));
  rank(ranked);
  for (const Evaluation& each : rank_by_samples(problem(sphere), ranked, {model, map, {}}, {})) {
    EXPECT_EQ(each.expected->samples, 1);
    EXPECT_EQ(each.score, each.utility);
  }
}

TEST_F(ExpectedUtility, ConvolvesWithTheErrorOfEachMove) {
  const Candidates cube = view_cube(5, Vec3::Constant(4), 1.0, 2.5, Vec3::Zero());
  PoseError::Vector per_metre = PoseError::Vector::Zero();
  per_metre.head<3>() = Vec3::Constant(0.2);
  const GrowingError growing(PoseError(), per_metre);
  const ViewEvaluation asked = problem(cube);
  std::vector<double> utilities;
  std::vector<PositioningError> errors;
  const std::vector<Evaluation> evaluations = evaluate_all(asked);
  for (const Evaluation& each : evaluations) {
    utilities.push_back(each.utility);
    const double distance = (each.view.position() - asked.current.position()).norm();
    errors.push_back(PositioningError::from_deviations(Vec3::Constant(0.2 * distance)));
  }
  const std::vector<double> expected = convolve_each(utilities, cube, errors);
  for (const Evaluation& each : rank_by_convolution(asked, evaluations, growing, {})) {
    EXPECT_NEAR(each.score, expected[static_cast<std::size_t>(each.candidate)], 1e-12);
  }
}

TEST(ExpectationOptions, NameTheBadValue) {
  for (const auto& change : std::vector<std::function<void(ExpectationOptions&)>>{
           [](auto& o) { o.candidates = 0; }, [](auto& o) { o.samples = 10; }, [](auto& o) { o.samples = 33; },
           [](auto& o) { o.least_overlap = 1.5; }, [](auto& o) { o.least_overlap = -0.1; }}) {
    ExpectationOptions options;
    change(options);
    EXPECT_THROW(options.validate(), InputError);
  }
}

}  // namespace
}  // namespace vantage
