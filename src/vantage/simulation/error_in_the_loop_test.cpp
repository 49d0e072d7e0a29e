#include <gtest/gtest.h>

#include "vantage/simulation/objects.hpp"
#include "vantage/simulation/simulate.hpp"

namespace vantage {
namespace {

/// A reconstruction of a sphere that takes milliseconds, by a robot that misses by 10 cm and 2 degrees.
ReconstructOptions small_run() {
  ReconstructOptions options;
  options.voxel = 0.08;
  options.scene = Index3::Constant(51);
  options.enclosure = Index3::Constant(13);
  options.camera = "45x45:80x80";
  options.candidates = "sphere:20:2";
  options.positioning_error = Vec3::Constant(0.1);
  options.orientation_error = Vec3::Constant(2);
  options.convolve = "samples";
  return options;
}

class ErrorInTheLoop : public ::testing::Test {
 protected:
  SimulatedObject object_{make_object("sphere"), 0.815, small_run()};
};

TEST_F(ErrorInTheLoop, LearnsFromEveryRegisteredScanAfterTheFirst) {
  ReconstructOptions options = small_run();
  options.believed_error = "learn";
  const SimulatedRun run = simulate(object_, options);
  ASSERT_GE(run.model.scans.size(), 3U);
  ErrorLearner learner;
  for (const ScanRecord& record : run.model.scans) {
    if (record.scan > 0) learner.add(record.commanded, record.registered);
    ASSERT_TRUE(record.learned_error);
    EXPECT_EQ(record.learned_error->covariance, learner.estimate().covariance) << record.scan;
    EXPECT_EQ(record.learned_error->mean, learner.estimate().mean) << record.scan;
    EXPECT_GT(rotation_angle(record.true_view->world_from_sensor.linear(), record.commanded.world_from_sensor.linear()),
              1e-4);
  }
}

TEST_F(ErrorInTheLoop, PlansWithSampledPosesAndSaysSo) {
  const SimulatedRun run = simulate(object_, small_run());
  ASSERT_GE(run.model.scans.size(), 3U);
  for (const ScanRecord& record : run.model.scans) {
    EXPECT_FALSE(record.learned_error) << "nothing was to be learned";
    if (record.scan == 0) continue;
    ASSERT_TRUE(record.planned && record.planned->expected);
    EXPECT_EQ(record.planned->score, record.planned->expected->utility);
    EXPECT_GE(record.planned->expected->registers, 0);
    EXPECT_LE(record.planned->expected->registers, 1 + 1e-12);
    EXPECT_NE(record.reason.find("to be registered with probability"), std::string::npos) << record.reason;
  }
  EXPECT_GT(*run.model.scans.back().coverage, 0.9);
}

}  // namespace
}  // namespace vantage
