#include "vantage/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/files/packed_array.hpp"
#include "vantage/runs/document_geometry.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

SceneOptions small_scene() {
  SceneOptions scene;
  scene.voxel_length = 0.1;
  scene.scene_size = Index3::Constant(7);
  scene.enclosure_size = Index3::Constant(3);
  return scene;
}

TEST(MapRecorder, TellsWhatEachScanChanged) {
  VoxelMap map(small_scene());
  MapRecorder recorder;
  map.set_label({2, 2, 2}, Label::empty);        // local (0,0,0), number 0
  map.add_point({4, 3, 2}, Vec3(0, 0, 1), 0.5);  // local (2,1,0), number 5
  const MapChange first = recorder.changes(map);
  std::vector<std::uint8_t> expected(27, 0);
  expected[0] = 1 + 2;
  expected[5] = 1 + 1;
  EXPECT_EQ(first.labels, expected);
  EXPECT_THAT(first.voxels, ElementsAre(5));
  EXPECT_THAT(first.normals, ElementsAre(0, 0, 127));
  EXPECT_THAT(first.quality, ElementsAre(128));

  map.add_point({4, 3, 2}, Vec3(0, -1, 0), 0.25);  // its quality stays, its normal turns by 45 degrees
  map.add_point({2, 2, 4}, Vec3::Zero(), 0);       // a point without a normal: occupied, no surface
  const MapChange second = recorder.changes(map);
  expected.assign(27, 0);
  expected[18] = 1 + 1;
  EXPECT_EQ(second.labels, expected);
  EXPECT_THAT(second.voxels, ElementsAre(5));
  EXPECT_THAT(second.normals, ElementsAre(0, -90, 90));
  EXPECT_THAT(second.quality, ElementsAre(128));

  const MapChange third = recorder.changes(map);
  EXPECT_EQ(third.labels, std::vector<std::uint8_t>(27, 0));
  EXPECT_TRUE(third.voxels.empty());
}

TEST(MapRecorder, RefusesAnotherEnclosure) {
  MapRecorder recorder;
  (void)recorder.changes(VoxelMap(small_scene()));
  SceneOptions other = small_scene();
  other.enclosure_size = Index3::Constant(5);
  EXPECT_THROW((void)recorder.changes(VoxelMap(other)), InputError);
}

TEST(CandidatePlan, PutsEvaluationsInTheOrderOfTheCandidates) {
  Plan plan;
  plan.best.candidate = 2;
  plan.ranking.resize(1);
  plan.ranking[0].candidate = 2;
  plan.ranking[0].utility = plan.ranking[0].score = 0.5;
  plan.ranking[0].resolution = {4, 4};
  plan.ranking[0].seen.occplane = 7;
  plan.infeasible.resize(1);
  plan.infeasible[0].candidate = 0;
  plan.infeasible[0].feasible = false;
  plan.infeasible[0].reason = "in the <wall>";
  const CandidatePlan result = candidate_plan(plan, 3);
  ASSERT_EQ(result.evaluations.size(), 3U);
  EXPECT_EQ(result.chosen, 2);
  EXPECT_FALSE(result.convolved);
  EXPECT_FALSE(result.evaluations[0].feasible);
  EXPECT_FALSE(result.evaluations[1].evaluated());
  EXPECT_EQ(result.evaluations[2].seen.occplane, 7);

  const Json json = plan_json(result);
  const std::vector<std::uint32_t> n_op{0, 0, 7};
  const std::vector<std::uint8_t> infeasible{1, 0, 0};
  EXPECT_EQ(json["n_op"], packed_array<std::uint32_t>(n_op));
  EXPECT_EQ(json["infeasible"], packed_array<std::uint8_t>(infeasible));
  EXPECT_EQ(json["reasons"], Json::array({"in the <wall>"}));
  EXPECT_TRUE(json["convolved"].is_null());
}

TEST(ReportGeometry, QuantisesWithinHalfAStep) {
  const std::vector<Vec3> points{{-1, 2, 0.5}, {0.123456, 2.5, 0.75}, {3, 2.25, 0.6}};
  const QuantisedPoints q = quantised(points);
  EXPECT_EQ(q.origin, Vec3(-1, 2, 0.5));
  EXPECT_DOUBLE_EQ(q.step, 4.0 / 65535);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double back = q.origin[axis] + q.step * q.values[3 * i + static_cast<std::size_t>(axis)];
      EXPECT_NEAR(back, points[i][axis], q.step / 2 * (1 + 1e-9));
    }
  }
  EXPECT_EQ(quantised({Vec3(1, 1, 1)}).values, std::vector<std::uint16_t>(3, 0));
}

/// A square of n x n cells in the plane z = 0.
TriangleMesh square(int n) {
  TriangleMesh mesh;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) mesh.vertices.emplace_back(static_cast<double>(x) / n, static_cast<double>(y) / n, 0);
  }
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const int corner = y * (n + 1) + x;
      mesh.triangles.emplace_back(corner, corner + 1, corner + n + 2);
      mesh.triangles.emplace_back(corner, corner + n + 2, corner + n + 1);
    }
  }
  return mesh;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    sum += (mesh.corner(i, 1) - mesh.corner(i, 0)).cross(mesh.corner(i, 2) - mesh.corner(i, 0)).norm() / 2;
  }
  return sum;
}

TEST(ReportGeometry, ThinsAMeshWithoutLosingItsShape) {
  const TriangleMesh mesh = square(100);
  const TriangleMesh small = thinned(mesh, 2000);
  EXPECT_LE(small.triangles.size(), 2000U);
  EXPECT_GT(small.triangles.size(), 500U);
  EXPECT_NEAR(area(small), 1, 0.1);  // clusters draw the border in by half a cell
  EXPECT_EQ(thinned(mesh, 20000).triangles.size(), mesh.triangles.size());
}

TEST(ReportGeometry, KeepsAnEvenChoiceOfTheCloud) {
  PointCloud cloud;
  for (int i = 0; i < 10; ++i) cloud.add(Vec3(i, 0, 0), Vec3(0, 0, 1));
  const Json json = cloud_json(cloud, {0, 0, 0, 0, 0, 1, 1, 1, 1, 1}, 4);
  EXPECT_EQ(json["total"], 10);
  EXPECT_EQ(json["points"]["shape"], Json::array({4, 3}));  // points 0, 3, 6, 9
  const std::vector<std::uint16_t> scans{0, 0, 1, 1};
  EXPECT_EQ(json["scan_of_point"], packed_array<std::uint16_t>(scans, 1, PackedRows::differences));
  EXPECT_TRUE(cloud_json({}, {}, 4).is_null());
  EXPECT_THROW((void)cloud_json(cloud, {1}, 4), InputError);
}

TEST(FillPage, WritesDataThatCannotEndTheirElement) {
  constexpr std::string_view page =
      "<body><!--vantage-static--><script type=\"application/json\" id=\"vantage-data\"></script></body>";
  const std::string html = fill_page(page, Json{{"object", "</script><b>\xff"}}, "<p>picture</p>");
  EXPECT_EQ(html,
            "<body><p>picture</p><script type=\"application/json\" id=\"vantage-data\">"
            "{\"object\":\"\\u003c/script>\\u003cb>\xEF\xBF\xBD\"}</script></body>");
  EXPECT_THROW((void)fill_page("<body></body>", Json{}, ""), Error);
}

TEST(ReportHtml, FillsTheEmbeddedPage) {
  RunData run;
  run.command = "reconstruct";
  run.object = "a <b>mug</b>";
  run.candidates = view_sphere(20, 2, Vec3::Zero());
  const SceneOptions scene = small_scene();
  run.grid = scene.grid();
  run.enclosure = scene.enclosure();
  ObjectModel model(scene, 0.01);
  model.map.add_point({4, 3, 2}, Vec3(0, 0, 1), 0.5);
  ScanRecord record;
  record.candidate = 3;
  run.add_scan(record, model, nullptr);
  run.finish(model, "nothing left");
  const std::string html = report_html(run);
  EXPECT_THAT(html, HasSubstr(R"("format":"vantage-run","version":1)"));
  EXPECT_THAT(html, HasSubstr(R"("object":"a \u003cb>mug\u003c/b>")"));
  EXPECT_THAT(html, HasSubstr(R"("stop_reason":"nothing left")"));
  EXPECT_THAT(html, Not(HasSubstr("http-equiv=\"refresh\"")));
  EXPECT_THAT(html, Not(HasSubstr("<script src")));
}

TEST(RunDataOfOptions, NotesWhatDiffersFromTheDefaults) {
  ReconstructOptions options;
  options.max_views = 7;
  options.positioning_error = Vec3(0.05, 0.05, 0.1);
  options.navigation = false;
  options.size = 0.5;
  TriangleMesh truth;
  truth.vertices.emplace_back(1, 2, 3);
  const RunData run = run_data(options, "mug", "1.2.3", truth);
  const std::vector<std::pair<std::string, std::string>> expected{
      {"--size", "0.5"},           {"--camera", "45x45:320x320"}, {"--candidates", "sphere:80:2"},
      {"--search", "exhaustive"},  {"--navigation", "no"},        {"--positioning-error", "0.05,0.05,0.1"},
      {"--registration", "truth"}, {"--max-views", "7"}};
  EXPECT_EQ(run.options, expected);
  EXPECT_EQ(run.candidates.views.size(), 80U);
  EXPECT_EQ(run.enclosure.size(), Index3::Constant(55));
  EXPECT_EQ(run.truth.vertices, truth.vertices);
}

}  // namespace
}  // namespace vantage
