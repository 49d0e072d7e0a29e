#include "vantage/utility/ray_information.hpp"

#include <gtest/gtest.h>

#include "vantage/core/error.hpp"
#include "vantage/utility/edge_proximity.hpp"
#include "vantage/utility/registry.hpp"

namespace vantage {
namespace {

constexpr Label empty = Label::empty, occupied = Label::occupied, unmarked = Label::unmarked,
                occluded = Label::occluded, occplane = Label::occplane;

/// A row of ten voxels of 2 cm along x; a ray that comes from x = 1 m meets the last of `labels` first.
struct Row {
  Grid grid{Vec3::Zero(), 0.02, Index3(10, 1, 1)};
  VoxelMap map{grid, {Index3::Zero(), Index3(9, 0, 0)}};
  RangeCamera camera = camera_from_apertures(radians(0.01), radians(0.01), {1, 1});
  View view = view_towards({1, 0.01, 0.01}, {0, 0.01, 0.01});

  /// In the order in which the ray passes them; the rest behind is empty.
  explicit Row(const std::vector<Label>& passed) {
    for (int i = 0; i < 10; ++i) {
      const auto k = static_cast<std::size_t>(i);
      map.set_label({9 - i, 0, 0}, k < passed.size() ? passed[k] : empty);
    }
  }
  template <class Sum>
  [[nodiscard]] double value(double x_oc = 1, const std::vector<View>& scanned = {}) const {
    const VisibilityEvaluator visibility(map);
    ViewToJudge judged{.candidate = 0, .view = view, .resolution = {1, 1}, .ideal = {79, 79}};
    judged.factors.x_oc = x_oc;
    const std::vector<ViewToJudge> views{judged};
    return sum_along_rays<Sum>(Choice{map, visibility, camera, view, scanned, 1, views}).front();
  }
};

// H(0.5) = ln 2; H(0.12) = -0.12 ln 0.12 - 0.88 ln 0.88; H(0.97) = -0.97 ln 0.97 - 0.03 ln 0.03, by hand:
constexpr double h_unknown = 0.6931471805599453;
constexpr double h_empty = 0.12 * 2.120263536200091 + 0.88 * 0.12783337150988489;
constexpr double h_occupied = 0.97 * 0.030459207484708574 + 0.03 * 3.506557897319982;

// Empty, two unknown, occupied; what comes behind does not count.
const std::vector<Label> back_of_surface{empty, occplane, unmarked, occupied, occluded};
// Unknown, empty, occupied.
const std::vector<Label> front_of_surface{unmarked, empty, occupied};
const std::vector<Label> nothing_behind{empty, occplane, occluded};

TEST(RayInformation, OcclusionAwareWeighsEntropyByVisibility) {
  // P_v: 1, 0.88, 0.88 * 0.5, 0.88 * 0.25.
  EXPECT_NEAR(Row(back_of_surface).value<OcclusionAware>(),
              h_empty + 0.88 * h_unknown + 0.44 * h_unknown + 0.22 * h_occupied, 1e-12);
  EXPECT_NEAR(Row(front_of_surface).value<OcclusionAware>(), h_unknown + 0.5 * h_empty + 0.44 * h_occupied, 1e-12);
}

TEST(RayInformation, UnobservedVoxelCountsUnknownOnesAlone) {
  EXPECT_NEAR(Row(back_of_surface).value<UnobservedVoxel>(), (0.88 + 0.44) * h_unknown, 1e-12);
  EXPECT_NEAR(Row(front_of_surface).value<UnobservedVoxel>(), h_unknown, 1e-12);
}

TEST(RayInformation, RearSideCountsRaysWithUnknownDirectlyBeforeTheSurface) {
  EXPECT_EQ(Row(back_of_surface).value<RearSideVoxel>(), 1);
  EXPECT_EQ(Row(front_of_surface).value<RearSideVoxel>(), 0);
  EXPECT_EQ(Row(nothing_behind).value<RearSideVoxel>(), 0);
  EXPECT_EQ(Row({occupied}).value<RearSideVoxel>(), 0);
}

TEST(RayInformation, RearSideEntropyTakesTheRunBeforeTheSurface) {
  EXPECT_NEAR(Row(back_of_surface).value<RearSideEntropy>(), (0.88 + 0.44) * h_unknown, 1e-12);
  // The unknown voxel in front of the gap does not belong to the run: P_v of the last is 0.5 * 0.88.
  EXPECT_NEAR(Row({unmarked, empty, occluded, occupied}).value<RearSideEntropy>(), 0.44 * h_unknown, 1e-12);
  EXPECT_EQ(Row(nothing_behind).value<RearSideEntropy>(), 0);
}

TEST(RayInformation, AverageEntropyIsPerVoxelOfRaysThatEndOccupied) {
  EXPECT_NEAR(Row(back_of_surface).value<AverageEntropy>(), (h_empty + 2 * h_unknown + h_occupied) / 4, 1e-12);
  EXPECT_EQ(Row(nothing_behind).value<AverageEntropy>(), 0);
}

TEST(RayInformation, KriegelsGainNeedsAFifthOfOverlap) {
  EXPECT_NEAR(Row(back_of_surface).value<KriegelGain>(0.2), 2 * h_unknown, 1e-12);
  EXPECT_EQ(Row(back_of_surface).value<KriegelGain>(0.19), 0);
}

TEST(RayInformation, ProximityFallsWithTheCellsBehindTheScannedSurface) {
  // The scan came from the other side, x = -1: the surface at x = 0 hides the voxels 1, 2 and 3 from it.
  Row row({unmarked, empty, empty, empty, empty, empty, occplane, occluded, occluded, occupied});
  const View scan = view_towards({-1, 0.01, 0.01}, {0, 0.01, 0.01});
  // d_max = 0.6 m / 2 cm = 30. The ray meets: unmarked (d = 30), d = 3, 2, 1.
  EXPECT_NEAR((row.value<ProximityCount>(1, {scan})), 0 + 27 + 28 + 29, 1e-12);
  EXPECT_EQ((row.value<ProximityCount>(1, {row.view})), 0) << "from this side nothing is behind a surface";
}

TEST(RayInformation, AporaFollowsTheEdges) {
  // Fewer than six edge voxels: nothing to go by.
  EXPECT_EQ(Row(back_of_surface).value<AporaSum>(), 0);
  // A sheet of unknown voxels in the plane y = 1 with occupied ones at z = 0 and everything around empty: all unknown
  // voxels at z = 1 are edges.
  const Grid grid{Vec3::Zero(), 0.02, Index3(7, 3, 4)};
  VoxelMap map(grid, grid.all());
  for (int z = 0; z < 4; ++z) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 7; ++x) map.set_label({x, y, z}, y != 1 ? empty : z == 0 ? occupied : unmarked);
    }
  }
  const VisibilityEvaluator visibility(map);
  const RangeCamera camera = camera_from_apertures(radians(0.01), radians(0.01), {1, 1});
  // Down the column x = 3, y = 1 from above: z = 3, 2, 1, then the occupied one.
  const View view = view_towards({0.07, 0.03, 1}, {0.07, 0.03, 0});
  const std::vector<ViewToJudge> views{{.candidate = 0, .view = view, .resolution = {1, 1}, .ideal = {79, 79}}};
  const Choice choice{map, visibility, camera, view, {}, 1, views};
  const EdgeProximity edges(choice);
  ASSERT_EQ(edges.edges().size(), 7U);
  // Of x = 3, z = 1: squared distances 0, 1, 1, 4, 4, 9 = 19; one step up 6 more, two steps up 6 * 4 more.
  const double p1 = std::exp(-0.01 * 19);
  const double p2 = std::exp(-0.01 * 25);
  const double p3 = std::exp(-0.01 * 43);
  EXPECT_NEAR(edges.at({3, 1, 1}), p1, 1e-6);
  EXPECT_EQ(edges.at({3, 1, 0}), 0) << "occupied";
  EXPECT_NEAR(sum_along_rays<AporaSum>(choice).front(), (p3 + (1 - p3) * p2 + (1 - p3) * (1 - p2) * p1) * h_unknown,
              1e-6);
}

TEST(RayInformation, SharesOneTraversal) {
  const Row row(back_of_surface);
  const VisibilityEvaluator visibility(row.map);
  const std::vector<ViewToJudge> views{{.candidate = 0, .view = row.view, .resolution = {1, 1}, .ideal = {79, 79}}};
  const Choice choice{row.map, visibility, row.camera, row.view, {}, 1, views};
  const auto both = sum_along_rays<RaySums<UnobservedVoxel, RearSideVoxel>>(choice).front();
  EXPECT_EQ(both[0], row.value<UnobservedVoxel>());
  EXPECT_EQ(both[1], 1);
}

TEST(FieldUtilities, CountWhatTheyAreMadeOf) {
  Visibility seen;
  seen.occplane = 30;
  seen.unmarked = 10;
  seen.occupied = 25;
  const auto sanchiz = std::get<CountUtility>(utility_by_name("sanchiz-fisher").score);
  EXPECT_EQ(sanchiz(seen, {}), 40 + 25);
  seen.occupied = 500;
  EXPECT_EQ(sanchiz(seen, {}), 40 + 40);

  Row row({empty, unmarked, occluded});
  const VisibilityEvaluator visibility(row.map);
  ViewToJudge view{.candidate = 0, .view = row.view, .resolution = {1, 1}, .ideal = {79, 79}};
  const std::vector<ViewToJudge> views{view};
  EXPECT_EQ(judge(utility_by_name("blaer-allen"), {row.map, visibility, row.camera, row.view, {}, 1, views}),
            std::vector<double>{1});

  row.map.set_label({8, 0, 0}, occupied);
  row.map.add_point({8, 0, 0}, Vec3::UnitX(), 0.8);
  const VisibilityEvaluator after(row.map);
  view.seen.occplane = 5;
  ViewToJudge other = view;
  other.seen.occplane = 10;
  const std::vector<ViewToJudge> both{view, other};
  const auto massios = judge(utility_by_name("massios-fisher"), {row.map, after, row.camera, row.view, {}, 1, both});
  EXPECT_NEAR(massios[0], 0.5 * 5 / 10 + 0.5 * 0.2, 1e-12);
  EXPECT_NEAR(massios[1], 0.5 + 0.5 * 0.2, 1e-12);
}

TEST(FieldUtilities, DrawAndSpreadWithoutTheMap) {
  const Row row({empty});
  const VisibilityEvaluator visibility(row.map);
  std::vector<ViewToJudge> views(3);
  const Vec3 center = row.map.enclosure_center();
  const Vec3 directions[] = {Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitX()};
  for (int i = 0; i < 3; ++i) {
    views[static_cast<std::size_t>(i)].candidate = i;
    views[static_cast<std::size_t>(i)].view = view_towards(center + directions[i], center);
  }
  const std::vector<View> scanned{views[0].view};
  const Choice choice{row.map, visibility, row.camera, views[0].view, scanned, 7, views};
  const auto spread = judge(utility_by_name("uniform"), choice);
  EXPECT_NEAR(spread[0], 0, 1e-6);
  EXPECT_NEAR(spread[1], radians(90), 1e-6);
  EXPECT_NEAR(spread[2], radians(180), 1e-6);

  const auto drawn = judge(utility_by_name("random"), choice);
  const std::vector<ViewToJudge> without_first(views.begin() + 1, views.end());
  const auto later = judge(utility_by_name("random"), {row.map, visibility, row.camera, {}, scanned, 7, without_first});
  EXPECT_EQ(later[0], drawn[1]) << "the order of a seed is fixed";
  const auto other = judge(utility_by_name("random"), {row.map, visibility, row.camera, {}, scanned, 8, views});
  EXPECT_NE(other, drawn);
}

TEST(Registry, ListsItsNamesWhereOneIsUnknown) {
  try {
    (void)utility_by_name("rse2");
    FAIL();
  } catch (const InputError& error) {
    for (const std::string& name : utility_names()) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << name;
    }
  }
  EXPECT_GE(utility_names().size(), 16U);
}

}  // namespace
}  // namespace vantage
