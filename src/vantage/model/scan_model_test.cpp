#include "vantage/model/scan_model.hpp"

#include <gmock/gmock.h>

namespace vantage {
namespace {

using testing::ElementsAre;

ScanRecord scan_from(const View& view, int candidate = -1) {
  ScanRecord record;
  record.candidate = candidate;
  record.registered = view;
  return record;
}

TEST(TellOfScans, NamesTheCandidatesThatScansWereMergedFrom) {
  SceneOptions scene;
  scene.voxel_length = 0.1;
  scene.scene_size = Index3::Constant(41);
  scene.enclosure_size = Index3::Constant(11);
  VoxelMap map(scene);
  map.set_label({25, 20, 20}, Label::occluded);
  map.update_occplane();
  PlannerOptions options;
  options.utility = "random";  // takes no view twice
  Planner planner(view_sphere(20, 2, Vec3::Zero()), camera_from_apertures(radians(45), radians(45), {20, 20}), options);
  const std::vector<View>& views = planner.candidates().views;

  View near = views[7];
  near.world_from_sensor.translation() += Vec3(0.01, -0.01, 0);
  View off = views[9];
  off.world_from_sensor.translation() += Vec3(0.03, 0, 0);
  View turned = views[11];
  turned.world_from_sensor.rotate(Eigen::AngleAxisd(radians(1.5), Vec3::UnitX()));
  ScanRecord failed = scan_from(views[5], 5);
  failed.merged = false;
  tell_of_scans(planner, std::vector{scan_from(off, 3), failed, scan_from(near), scan_from(off), scan_from(turned)});

  const auto plan = planner.next_best_view(map, views[0]);
  ASSERT_TRUE(plan);
  std::vector<int> scanned;
  for (const Evaluation& each : plan->infeasible) {
    EXPECT_EQ(each.reason, "has been scanned from");
    scanned.push_back(each.candidate);
  }
  EXPECT_THAT(scanned, ElementsAre(3, 7));
}

/// Refuses the scans whose believed position is this far off or farther.
class RefusingRegistrar : public Registrar {
 public:
  [[nodiscard]] Located locate(const ModelSurface&, const Scan&, const PointCloud&, const View& believed) override {
    return {believed, believed.position().norm() < 100, 1, 0, "", ""};
  }
};

TEST(ScanModel, TheSensorsDistanceIsThatOfMergedScans) {
  ScanPlanOptions options;
  options.voxel = 0.1;
  const ScanScene scene = scene_in(Box3(Vec3(0.5, 0, 0), Vec3(1.5, 1, 1)), options);
  ScanModel scans(scene);
  RefusingRegistrar registrar;
  RangeImage image{camera_from_apertures(radians(45), radians(45), {10, 10}), std::vector<float>(100, 1.9F)};
  EXPECT_EQ(scans.sensor_distance(), 0);
  const auto add = [&](double distance) {
    const Vec3 position = scene.scene.center + Vec3(0, 0, distance);
    (void)scans.add({}, scan_of(image), view_towards(position, scene.scene.center), registrar);
    return scans.sensor_distance();
  };
  EXPECT_DOUBLE_EQ(add(2), 2);
  EXPECT_DOUBLE_EQ(add(3), 2.5);
  EXPECT_DOUBLE_EQ(add(1000), 2.5) << "was not merged";
  EXPECT_DOUBLE_EQ(add(50), 3) << "one that is far off moves the median to its neighbour";
}

TEST(TypicalDistance, IsTheMedian) {
  EXPECT_EQ(typical_distance({}), 0);
  EXPECT_EQ(typical_distance({3}), 3);
  EXPECT_EQ(typical_distance({900, 1}), 450.5);
  EXPECT_EQ(typical_distance({1, 900, 2}), 2);
  EXPECT_EQ(typical_distance({4, 900, 1, 2}), 3);
}

}  // namespace
}  // namespace vantage
