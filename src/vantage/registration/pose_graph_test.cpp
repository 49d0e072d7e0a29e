#include "vantage/registration/pose_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"

namespace vantage {
namespace {

const Vec3 center(0.1, -0.2, 0.05);

/// Information of steps that are right within `sigma` metres in every component.
Mat6 within(double sigma) { return Mat6::Identity() / (sigma * sigma); }

Vec6 random_step(Random& random, double sigma) {
  Vec6 step;
  step.head<3>() = sigma * random.normal3();
  step.tail<3>() = sigma * random.normal3();
  return step;
}

/// Sensors evenly around the center, which all look at it.
std::vector<Pose> ring(int count) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    poses.push_back(look_at(center + Vec3(std::cos(angle), std::sin(angle), 0.4), center));
  }
  return poses;
}

/// A pair that is off the truth by `error`.
PoseConstraint pair(const std::vector<Pose>& truth, std::size_t from, std::size_t to, const Vec6& error, double sigma) {
  return {from, to, truth[from].inverse() * stepped(truth[to], error), within(sigma)};
}

/// A ring whose pairs of neighbours each err by `sigma` per component, begun with the poses that adding them up gives.
PoseGraph erring_ring(int count, double sigma, std::uint64_t seed) {
  Random random(seed, 0);
  const std::vector<Pose> truth = ring(count);
  PoseGraph graph;
  graph.priors.push_back({0, truth[0], within(1e-6)});
  graph.poses.push_back(truth[0]);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    graph.constraints.push_back(pair(truth, i, (i + 1) % truth.size(), random_step(random, sigma), sigma));
    if (i + 1 < truth.size()) graph.poses.push_back(graph.poses[i] * graph.constraints[i].from_of_to);
  }
  return graph;
}

std::vector<double> steps_at(const PoseGraph& graph, std::span<const Pose> poses) {
  std::vector<double> lengths;
  for (const PoseConstraint& each : graph.constraints) lengths.push_back(residual(each, poses).norm());
  return lengths;
}

TEST(PoseGraph, RingOf24ViewsWithFiveMillimetresPerPairClosesWithoutAStep) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const PoseGraph graph = erring_ring(24, 0.005, seed);
    const double gap = steps_at(graph, graph.poses).back();
    const SolvedPoses solved = solve(graph);
    ASSERT_TRUE(solved.converged);
    const std::vector<double> steps = steps_at(graph, solved.poses);
    // What was left over at the end is spread over all 24 pairs, the closing one as much as the others.
    const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
    EXPECT_LT(*most, 2 * gap / 24) << "seed " << seed;
    EXPECT_LT(*most, 3 * *least) << "seed " << seed;
  }
}

TEST(PoseGraph, ExactPairsAreKeptFromPosesThatAreOff) {
  const std::vector<Pose> truth = ring(12);
  Random random(7, 0);
  PoseGraph graph;
  graph.priors.push_back({3, truth[3], within(1e-4)});
  for (std::size_t i = 0; i < truth.size(); ++i) {
    graph.poses.push_back(stepped(truth[i], random_step(random, 0.03)));
    graph.constraints.push_back(pair(truth, i, (i + 1) % 12, Vec6::Zero(), 0.002));
    graph.constraints.push_back(pair(truth, i, (i + 3) % 12, Vec6::Zero(), 0.002));
  }
  const SolvedPoses solved = solve(graph);
  ASSERT_TRUE(solved.converged);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT(pose_step(truth[i], solved.poses[i]).norm(), 1e-6) << i;
  }
  EXPECT_THAT(solved.weights, testing::Each(testing::DoubleNear(1, 1e-6)));
}

TEST(PoseGraph, TwoBeliefsMeetWhereTheirInformationSays) {
  // One pose, believed at 0 within 1 cm and at 3 cm within 2 cm: the mean weighted with 1 and 1/4 is 6 mm.
  PoseGraph graph;
  graph.poses = {Pose::Identity()};
  Vec6 shift = Vec6::Zero();
  shift.x() = 0.03;
  graph.priors = {{0, Pose::Identity(), within(0.01)}, {0, stepped(Pose::Identity(), shift), within(0.02)}};
  const SolvedPoses solved = solve(graph);
  EXPECT_NEAR(solved.poses[0].translation().x(), 0.006, 1e-12);
}

TEST(PoseGraph, DirectionsThatNoPairHoldsStayAsBelieved) {
  // Two views of a plane across z: the pair says nothing of shifts along it or turns about its normal.
  PoseGraph graph;
  Vec6 error = Vec6::Constant(0.001);
  graph.poses = {Pose::Identity(), stepped(Pose::Identity(), error)};
  graph.priors = {{0, graph.poses[0], within(1e-5)}, {1, graph.poses[1], within(0.01)}};
  Mat6 plane = Mat6::Zero();
  plane.diagonal() << 0, 0, 1e8, 1e8, 1e8, 0;
  graph.constraints = {{0, 1, Pose::Identity(), plane}};
  const Vec6 step = pose_step(graph.poses[0], solve(graph).poses[1]);
  Vec6 expected;
  expected << 0.001, 0.001, 0, 0, 0, 0.001;
  EXPECT_LT((step - expected).cwiseAbs().maxCoeff(), 5e-6) << step.transpose();
}

TEST(PoseGraph, AWrongPairDoesNotBendTheRest) {
  Random random(11, 0);
  const std::vector<Pose> truth = ring(16);
  PoseGraph graph;
  graph.poses = truth;
  graph.priors.push_back({0, truth[0], within(1e-6)});
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (const std::size_t ahead : {1U, 2U, 3U}) {
      graph.constraints.push_back(pair(truth, i, (i + ahead) % 16, random_step(random, 0.001), 0.001));
    }
  }
  const SolvedPoses without = solve(graph);
  Vec6 wrong;
  wrong << 0.2, -0.1, 0.05, 0.1, 0, 0.1;
  graph.constraints.push_back(pair(truth, 2, 9, wrong, 0.001));
  const SolvedPoses with = solve(graph);
  ASSERT_TRUE(with.converged);
  EXPECT_LT(with.weights.back(), 1e-3);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT(pose_step(without.poses[i], with.poses[i]).norm(), 2e-4) << i;
    EXPECT_LT(pose_step(truth[i], with.poses[i]).norm(), 0.005) << i;
  }
}

TEST(PoseGraph, MorePairsBringThePosesNearerToTheTruth) {
  // 24 views with pairs to three neighbours against one: the worst pose, over several draws.
  double worst_with_one = 0, worst_with_three = 0;
  for (const std::uint64_t seed : {21U, 22U, 23U, 24U, 25U, 26U}) {
    PoseGraph graph = erring_ring(24, 0.005, seed);
    const std::vector<Pose> truth = ring(24);
    const auto worst = [&](const SolvedPoses& solved) {
      double most = 0;
      for (std::size_t i = 0; i < 24; ++i) most = std::max(most, pose_step(truth[i], solved.poses[i]).norm());
      return most;
    };
    worst_with_one += worst(solve(graph));
    Random random(seed, 1);
    for (std::size_t i = 0; i < 24; ++i) {
      for (const std::size_t ahead : {2U, 3U}) {
        graph.constraints.push_back(pair(truth, i, (i + ahead) % 24, random_step(random, 0.005), 0.005));
      }
    }
    worst_with_three += worst(solve(graph));
  }
  EXPECT_LT(worst_with_three, 0.6 * worst_with_one);
}

TEST(PoseGraph, SaysWhatIsWrongWithIt) {
  PoseGraph graph;
  graph.poses = ring(3);
  const auto message = [&] {
    try {
      graph.validate();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  graph.priors = {{0, graph.poses[0], within(0.01)}};
  graph.constraints = {{0, 1, Pose::Identity(), within(0.01)}};
  EXPECT_THAT(message(), testing::HasSubstr("pose 2: no prior"));
  graph.constraints.push_back({1, 3, Pose::Identity(), within(0.01)});
  EXPECT_THAT(message(), testing::HasSubstr("constraint 1 ties pose 1 to 3"));
  graph.constraints[1] = {1, 2, Pose::Identity(), within(std::nan(""))};
  EXPECT_THAT(message(), testing::HasSubstr("constraint 1: its information must be finite"));
  graph.constraints[1].information = within(0.01);
  EXPECT_EQ(message(), "");
  EXPECT_TRUE(solve(PoseGraph()).converged);
}

}  // namespace
}  // namespace vantage
