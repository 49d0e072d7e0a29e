#include "vantage/model/reconstruction.hpp"

#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/simulation/objects.hpp"
#include "vantage/simulation/simulate.hpp"

namespace vantage {
namespace {

/// A reconstruction of a sphere that takes milliseconds: large voxels, few rays.
ReconstructOptions small_run() {
  ReconstructOptions options;
  options.voxel = 0.08;
  options.scene = Index3::Constant(51);
  options.enclosure = Index3::Constant(13);
  options.camera = "45x45:80x80";
  options.candidates = "sphere:20:2";
  return options;
}

class Loop : public ::testing::Test {
 protected:
  [[nodiscard]] SimulatedRun run(const ReconstructOptions& options, const RunObserver& observer = {}) const {
    return simulate(object_, options, observer);
  }

  SimulatedObject object_{make_object("sphere"), 0.815, small_run()};
};

TEST_F(Loop, ScansUntilNothingIsLeftToSee) {
  const SimulatedRun result = run(small_run());
  EXPECT_EQ(result.stop_reason, "no feasible view meets an occplane voxel any more");
  ASSERT_GE(result.model.scans.size(), 3U);
  EXPECT_GT(result.model.scans.back().coverage, 0.97) << "large voxels and few rays miss some";
  const Planner planner(small_run().candidate_views(), small_run().range_camera());
  double distance = 0;
  for (std::size_t i = 0; i < result.model.scans.size(); ++i) {
    const ScanRecord& record = result.model.scans[i];
    EXPECT_EQ(record.scan, static_cast<int>(i));
    EXPECT_TRUE(record.merged);
    if (i > 0) {
      const ScanRecord& before = result.model.scans[i - 1];
      distance += planner.travel().distance(before.commanded.position(), record.commanded.position());
      EXPECT_EQ(record.labels.occupied, before.labels.occupied + record.new_occupied);
      EXPECT_GE(*record.coverage, *before.coverage);
      ASSERT_TRUE(record.planned);
      EXPECT_EQ(record.planned->candidate, record.candidate);
    }
    EXPECT_NEAR(record.distance, distance, 1e-12);
  }
  EXPECT_EQ(result.model.map.count(Label::occupied), result.model.scans.back().labels.occupied);
  EXPECT_GT(result.model.surface.cloud().size(), 100U);
}

TEST_F(Loop, StopsWhereABudgetIsUsedUp) {
  ReconstructOptions options = small_run();
  options.max_views = 2;
  EXPECT_EQ(run(options).model.scans.size(), 2U);
  EXPECT_EQ(run(options).stop_reason, "the budget of 2 views is used up");
  options = small_run();
  options.max_distance = 0.1;
  EXPECT_EQ(run(options).model.scans.size(), 2U) << "the first move goes over the budget";
}

TEST_F(Loop, KeepsWhatItHasWhenInterrupted) {
  int scans = 0;
  RunObserver observer;
  observer.on_scan = [&](const ScanRecord&, const Scan&, const ObjectModel&, const Plan*) { ++scans; };
  observer.interrupted = [&] { return scans >= 2; };
  const SimulatedRun result = run(small_run(), observer);
  EXPECT_EQ(result.stop_reason, "interrupted");
  EXPECT_EQ(result.model.scans.size(), 2U);
}

TEST_F(Loop, RefusesAnInitialViewThatDoesNotExistOrIsNotFeasible) {
  ReconstructOptions options = small_run();
  options.initial_view = 20;
  EXPECT_THROW((void)run(options), InputError);
  options = small_run();
  options.workspace = "-3,-3,-3,3,3,-1.9";
  EXPECT_THROW((void)run(options), InputError);
}

/// Fails to reach some views and to register some scans.
class Unreliable : public Robot, public Registrar {
 public:
  Unreliable(const RangeScanner& scanner, const RangeCamera& camera) : robot_(scanner, camera, {}, 1) {}

  [[nodiscard]] bool move_to(const View& view) override { return ++moves_ % 3 != 0 && robot_.move_to(view); }
  [[nodiscard]] RangeImage take_range_image() override { return robot_.take_range_image(); }
  [[nodiscard]] View view() const override { return robot_.view(); }
  [[nodiscard]] Located locate(const ModelSurface&, const Scan&, const PointCloud&, const View& believed) override {
    const bool accepted = ++scans_ % 4 != 0;
    return {believed, accepted, 0.5, 0.001, accepted ? "registered" : "insufficient_overlap", ""};
  }

 private:
  SimulatedRobot robot_;
  int moves_ = 0;
  int scans_ = 0;
};

TEST_F(Loop, GoesOnPastUnreachableViewsAndFailedRegistrations) {
  const ReconstructOptions options = small_run();
  ObjectModel model(options.scene_options(), options.point_spacing());
  Planner planner(options.candidate_views(), options.range_camera());
  Unreliable unreliable(object_.scanner(), options.range_camera());
  Reconstruction loop(unreliable, planner, unreliable);
  loop.run(model, 0);
  int failed = 0;
  for (std::size_t i = 0; i < model.scans.size(); ++i) {
    if (model.scans[i].merged) continue;
    ++failed;
    EXPECT_EQ(model.scans[i].new_occupied, 0);
    EXPECT_EQ(model.scans[i].labels.occupied, model.scans[i - 1].labels.occupied) << "a failed scan is not merged";
    if (i + 1 < model.scans.size()) {
      EXPECT_NE(model.scans[i + 1].candidate, model.scans[i].candidate);
    }
  }
  EXPECT_GE(failed, 1);
  EXPECT_GT(object_.truth().coverage(model.map), 0.95);
}

TEST_F(Loop, PutsScansWhereTheRegistrationSays) {
  ReconstructOptions options = small_run();
  options.positioning_error = Vec3::Constant(0.02);
  options.registration = "truth";
  for (const ScanRecord& record : run(options).model.scans) {
    EXPECT_GT((record.true_view->position() - record.commanded.position()).norm(), 1e-4);
    EXPECT_TRUE(record.registered.position() == record.true_view->position());
  }
  options.registration = "none";
  for (const ScanRecord& record : run(options).model.scans) {
    EXPECT_TRUE(record.registered.position() == record.commanded.position());
  }
}

}  // namespace
}  // namespace vantage
