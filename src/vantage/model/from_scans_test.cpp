#include "vantage/model/from_scans.hpp"

#include <gmock/gmock.h>

#include <memory>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;

/// Scans of one point each, at (i, 0, 2) of the sensor that stands at the origin, which count how often they are read.
struct CountedScans {
  explicit CountedScans(int count) : reads(static_cast<std::size_t>(count)) {
    for (int i = 0; i < count; ++i) {
      pending.push_back({std::to_string(i), View{Pose::Identity()}, [this, i] {
                           ++reads[static_cast<std::size_t>(i)];
                           PointScan scan;
                           scan.points = {Vec3(i, 0, 2)};
                           scan.origins = {Vec3::Zero()};
                           return Scan(scan);
                         }});
    }
  }
  std::vector<int> reads;
  std::vector<PendingScan> pending;
};

double x_of(const PendingScan& scan) { return std::get<PointScan>(scan.read()).points.front().x(); }

TEST(FitScene, ReadsScansOnceForABoxAroundAllPoints) {
  CountedScans scans(4);
  const ScanScene fitted = fit_scene(scans.pending, {});
  EXPECT_THAT(scans.reads, ElementsAre(1, 1, 1, 1));
  EXPECT_NEAR(fitted.scene.center.x(), 1.5, 1e-12);
}

TEST(FitScene, ReadsScansUntilOneHasAPointInTheGivenBox) {
  CountedScans scans(4);
  ScanPlanOptions options;
  options.box.emplace() << 1, 0, 2, 0.5, 0.5, 0.5;
  (void)fit_scene(scans.pending, options);
  EXPECT_THAT(scans.reads, ElementsAre(1, 1, 0, 0));
  options.box.emplace() << 1, 5, 2, 0.5, 0.5, 0.5;
  EXPECT_THROW((void)fit_scene(scans.pending, options), InputError);
}

TEST(KeptForSecondReading, ScansAreDecodedOnceAsFarAsMemoryAllows) {
  constexpr std::size_t one = 2 * sizeof(Vec3);  // a point and an origin
  CountedScans scans(3);
  const std::vector<PendingScan> kept = kept_for_second_reading(scans.pending, 2 * one);
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(x_of(kept[static_cast<std::size_t>(i)]), i);
  }
  EXPECT_THAT(scans.reads, ElementsAre(1, 1, 2)) << "there was no room for the third";
  EXPECT_EQ(x_of(kept[0]), 0);
  EXPECT_THAT(scans.reads, ElementsAre(2, 1, 2)) << "a third reading is a new one";
}

}  // namespace
}  // namespace vantage
