#include "vantage/model/reconstruction.hpp"

#include <gmock/gmock.h>

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
  [[nodiscard]] bool estimates() const override { return false; }

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

/// Accepts or refuses as `accepts` says.
class Moody : public TrustingRegistrar {
 public:
  bool accepts = true;
  int asked = 0;

  [[nodiscard]] Located locate(const ModelSurface&, const Scan&, const PointCloud&, const View& believed) override {
    ++asked;
    return {believed, accepts, 1, 0, accepts ? "registered" : "insufficient_overlap", ""};
  }
  [[nodiscard]] bool estimates() const override { return true; }
};

TEST_F(Loop, TriesRefusedScansAgainWhenTheModelHasGrownNearThem) {
  const ReconstructOptions options = small_run();
  ObjectModel model(options.scene_options(), options.point_spacing());
  Moody registrar;
  const auto add = [&](std::size_t candidate) {
    const View view = options.candidate_views().views[candidate];
    const Scan scan = scan_of(object_.scanner().scan(options.range_camera(), view));
    model.scans.push_back(update(model, scan, view, registrar));
    return model.scans.back();
  };
  const std::int64_t first = add(0).labels.occupied;
  registrar.accepts = false;
  const ScanRecord refused = add(9);
  EXPECT_FALSE(refused.merged);
  EXPECT_FALSE(refused.merged_after);
  EXPECT_EQ(refused.labels.occupied, first);
  registrar.accepts = true;
  EXPECT_TRUE(conclude(model, registrar).empty());
  EXPECT_EQ(registrar.asked, 2) << "nothing has grown: it is not tried";

  const ScanRecord second = add(5);
  EXPECT_EQ(second.recovered, std::vector<int>{1});
  EXPECT_TRUE(model.waiting.empty());
  const ScanRecord& recovered = model.scans[1];
  EXPECT_TRUE(recovered.merged);
  EXPECT_EQ(recovered.merged_after, 2);
  EXPECT_GT(recovered.new_occupied, 0);
  EXPECT_EQ(second.labels.occupied, first + second.new_occupied + recovered.new_occupied);
  EXPECT_EQ(gains(model.scans), (std::vector<std::int64_t>{first, 0, second.new_occupied + recovered.new_occupied}));
  EXPECT_EQ(model.cloud_growth.back(), std::pair(1, model.surface.cloud().size()));
}

TEST_F(Loop, RefusedScansDoNotCountAsFruitless) {
  // Every scan after the first is refused: the run goes on until no view is left, not until the fourth of them.
  class OnlyTheFirst : public Moody {
   public:
    [[nodiscard]] Located locate(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                                 const View& believed) override {
      accepts = asked == 0;
      return Moody::locate(model, scan, points, believed);
    }
  } registrar;
  const ReconstructOptions options = small_run();
  ObjectModel model(options.scene_options(), options.point_spacing());
  Planner planner(options.candidate_views(), options.range_camera());
  SimulatedRobot robot(object_.scanner(), options.range_camera(), {}, 1);
  Reconstruction loop(robot, planner, registrar);
  loop.run(model, 0);
  EXPECT_GT(model.scans.size(), 6U);
  EXPECT_THAT(loop.stop_reason(), testing::HasSubstr("could not be registered"));
}

TEST_F(Loop, PutsScansWhereTheRegistrationSays) {
  ReconstructOptions options = small_run();
  options.positioning_error = Vec3::Constant(0.02);
  options.registration = "truth";
  for (const ScanRecord& record : run(options).model.scans) {
    EXPECT_GT((record.true_view->position() - record.commanded.position()).norm(), 1e-4);
    EXPECT_TRUE(record.registered.position() == record.true_view->position());
    EXPECT_EQ(record.pose_error, 0);
  }
  options.registration = "none";
  for (const ScanRecord& record : run(options).model.scans) {
    EXPECT_TRUE(record.registered.position() == record.commanded.position());
    // Every point is off by as much as the sensor, which is not turned.
    EXPECT_NEAR(*record.pose_error, (record.true_view->position() - record.commanded.position()).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace vantage
