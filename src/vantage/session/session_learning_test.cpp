#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/core/error.hpp"
#include "vantage/session/session_test_util.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

/// A ball of radius 0.3 m in the middle of the box.
SessionScan ball_from(const View& view) {
  const Vec3 position = view.position();
  return scan_from(view, [&](const Vec3& ray) {
    const double along = -position.dot(ray), square = ray.squaredNorm();
    const double root = along * along - square * (position.squaredNorm() - 0.09);
    return root > 0 ? static_cast<float>((along - std::sqrt(root)) / square) : RangeImage::no_return;
  });
}

SessionScan ball_from(const Vec3& position) { return ball_from(view_towards(position, Vec3::Zero())); }

TEST(SessionLearning, LearnsHowTheRobotErrsFromTheViewsItWasSentTo) {
  const TestFolder folder;
  ScanPlanningOptions options = small_options();
  options.scene.radius = 2;
  options.planning.convolve = "samples";
  options.planning.believed_error = "learn:0.2,0.2,0.1";
  Session::create(folder / "s", options);
  Session session(folder / "s");
  (void)session.add(ball_from({0, 0, 2}));
  const SessionPlan before = session.next();

  ErrorLearnerOptions prior;
  prior.prior_deviation = {0.2, 0.2, 0.1};
  ErrorLearner learner(prior);
  const Candidates candidates = view_sphere(20, 2, Vec3::Zero());
  const std::vector<Vec3> errors{{0.1, -0.05, 0}, {-0.08, 0.1, 0.05}, {0.12, 0.02, -0.03}};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const auto candidate = static_cast<int>(3 + 4 * i);
    const View& commanded = candidates.views[static_cast<std::size_t>(candidate)];
    View reached = commanded;
    reached.world_from_sensor.translation() += errors[i];
    SessionScan scan = ball_from(reached);
    if (i < 2) scan.candidate = candidate;
    if (i > 0) scan.commanded = commanded;  // either of them says where it was sent
    const ScanRecord record = session.add(scan);
    learner.add(commanded, reached);
    EXPECT_EQ(record.commanded.world_from_sensor.matrix(), commanded.world_from_sensor.matrix());
    EXPECT_TRUE(record.learned_error->covariance.isApprox(learner.estimate().covariance, 1e-12));
  }
  (void)session.add(ball_from({0.3, -2, 0.4}));  // taken from nowhere in particular: teaches nothing
  const SessionPlan after = session.next();
  ASSERT_TRUE(after.state->learner);
  EXPECT_EQ(after.state->learner->observations(), 3);
  EXPECT_EQ(before.state->learner->observations(), 0);

  // The plan goes by what was learned.
  Planner planner = options.planner(candidates, after.state->camera);
  tell_of_scans(planner, after.state->scans);
  const auto with_prior = planner.next_best_view(after.state->map, after.state->current);
  planner.believe(learner.prediction());
  const auto learned = planner.next_best_view(after.state->map, after.state->current);
  ASSERT_TRUE(after.plan && learned && with_prior);
  EXPECT_EQ(after.plan->best.candidate, learned->best.candidate);
  EXPECT_NEAR(after.plan->best.score, learned->best.score, 1e-12);
  EXPECT_GT(std::abs(after.plan->best.score - with_prior->best.score), 1e-6);
  EXPECT_THAT(after.plan->explanation, HasSubstr("with the robot's error"));
}

TEST(SessionLearning, PlansTheSameWithWhatItLearnedAfterARestart) {
  const TestFolder folder;
  ScanPlanningOptions options = small_options();
  options.planning.convolve = "samples";
  options.planning.believed_error = "learn";
  Session::create(folder / "at once", options);
  Session::create(folder / "restarted", options);
  Session at_once(folder / "at once");
  std::vector<SessionScan> scans{ball_from({0, 0, 2}), ball_from({1, 0.2, 1.6}), ball_from({0.3, -1.2, 1.5})};
  scans[1].candidate = 4;
  scans[2].candidate = 7;
  for (const SessionScan& scan : scans) {
    (void)at_once.add(scan);
    (void)Session(folder / "restarted").add(scan);
  }
  Session restarted(folder / "restarted");
  const SessionPlan plan = at_once.next(), again = restarted.next();
  EXPECT_EQ(plan.state->learner->observations(), 2);
  EXPECT_EQ(plan.state->learner->prediction().covariance, again.state->learner->prediction().covariance);
  EXPECT_EQ(plan.state->learner->prediction().mean, again.state->learner->prediction().mean);
  ASSERT_TRUE(plan.plan && again.plan) << plan.why_finished;
  EXPECT_EQ(plan.plan->best.score, again.plan->best.score);
}

TEST(SessionLearning, AsksHowTheRobotErrsWhereThatIsPlannedFor) {
  const TestFolder folder;
  const auto refused = [&](const char* convolve, std::optional<std::string> believed) {
    ScanPlanningOptions options = small_options();
    options.planning.convolve = convolve;
    options.planning.believed_error = std::move(believed);
    return input_error_of([&] { Session::create(folder / "s", options); });
  };
  EXPECT_THAT(refused("on", std::nullopt), HasSubstr("convolve = on: needs how the robot errs"));
  EXPECT_THAT(refused("smooth", "0.1,0.1,0.1"), HasSubstr("off, on, normalised, samples"));
  EXPECT_THAT(refused("off", "learn"), HasSubstr("nothing would use what is learned"));
  EXPECT_THAT(refused("on", "learned"), HasSubstr("must be SX,SY,SZ, learn or learn:SX,SY,SZ"));
  EXPECT_THAT(refused("on", "learn:0.1"), HasSubstr("has 1 numbers; must have 3"));
  EXPECT_THAT(refused("on", "learn:0.1,0,0.1"), HasSubstr("must be positive"));
  EXPECT_THAT(refused("on", "-0.1,0,0"), HasSubstr("must not be negative"));
}

}  // namespace
}  // namespace vantage
