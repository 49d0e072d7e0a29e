#include "vantage/report/static_report.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "support/markup.hpp"
#include "vantage/report/run_scene.hpp"

namespace vantage {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// A map with a small box in it and two scans, the second one planned.
struct SmallRun {
  VoxelMap map{SceneOptions{.scene_size = Index3::Constant(41), .enclosure_size = Index3::Constant(11)}};
  ReportData data;

  SmallRun() {
    for (int x = 18; x <= 22; ++x)
      for (int y = 18; y <= 22; ++y) map.add_point({x, y, 20}, Vec3(0, 0, 1), 0.8);
    data.object = "a <mug> & \"more\"";
    data.program = "vantage 0";
    data.candidates = view_sphere(20, 0.5, Vec3::Zero());
    data.map = &map;
    data.stop_reason = "no feasible view meets an occplane voxel any more";
    for (int k = 0; k < 2; ++k) {
      ScanRecord scan;
      scan.scan = k;
      scan.candidate = 3 * k;
      scan.commanded = scan.believed = scan.registered = data.candidates.views[static_cast<std::size_t>(3 * k)];
      scan.reason = k == 0 ? "initial view" : "best of 20 <ha>";
      scan.labels.occupied = 25;
      scan.distance = 0.625 * k;
      scan.coverage = 0.5 + 0.45 * k;
      data.scans.push_back(scan);
    }
    Evaluation planned;
    planned.seen.occplane = 1433;
    planned.factors.f_quality = 0.6394;
    planned.utility = 3.3416;
    data.scans[1].planned = planned;
  }
};

/// The page of the small run, made once for all tests that read it.
const std::string& page_of_small_run() {
  static const std::string page = static_report_html(SmallRun().data);
  return page;
}

TEST(StaticReport, IsWellFormedAndNeedsNothingElse) {
  const std::string& page = page_of_small_run();
  const ParsedMarkup parsed(page);
  EXPECT_THAT(page, Not(ContainsRegex("(src|href)=\"[^d#]")));  // data: only
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, Not(HasSubstr("url(")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
  EXPECT_TRUE(parsed.all("script").empty());
  for (const auto* image : parsed.all("img")) {
    EXPECT_THAT(image->Attribute("src"), HasSubstr("data:image/png;base64,"));
    EXPECT_STRNE(image->Attribute("alt"), nullptr);
  }
  EXPECT_EQ(parsed.all("img").size(), 10U);  // views, six sides, three colourings of the voxels
  EXPECT_LT(page.size(), 1500000U);
}

TEST(StaticReport, HasTheNumbersOfTheRun) {
  const std::string& body = page_of_small_run();
  EXPECT_THAT(body, HasSubstr("2 views over a way of 0.62 m covered 95.0 % of the surface that can be seen. It stopped "
                              "because no feasible view meets an occplane voxel any more."));
  EXPECT_THAT(body, HasSubstr("<td class=\"r\">1433</td>"));
  EXPECT_THAT(body, HasSubstr("<td class=\"r\">0.639</td>"));
  EXPECT_THAT(body, HasSubstr("<td class=\"r\">3.342</td>"));
}

TEST(StaticReport, EscapesWhatPeopleWrote) {
  const std::string& page = page_of_small_run();
  EXPECT_THAT(page, HasSubstr("<h1>a &lt;mug&gt; &amp; &quot;more&quot;</h1>"));
  EXPECT_THAT(page, HasSubstr("best of 20 &lt;ha&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("<ha>")));
  EXPECT_THAT(page, Not(HasSubstr("<mug>")));
}

TEST(StaticReport, ShowsWhatThereIsOfAnUnfinishedRun) {
  const ReportData nothing;
  const ParsedMarkup empty(static_report_html(nothing));
  EXPECT_TRUE(empty.all("img").empty());
  EXPECT_EQ(report_summary(nothing), "No scan has been taken yet.");

  SmallRun run;  // real scans: no coverage, and one that failed
  for (ScanRecord& scan : run.data.scans) scan.coverage.reset();
  run.data.scans[1].merged = false;
  run.data.scans[1].verdict = "overlap too small";
  run.data.scans[1].distance = NAN;
  run.data.stop_reason.clear();
  const std::string body = static_report_body(run.data);
  const ParsedMarkup parsed(body);
  EXPECT_THAT(body, HasSubstr("not merged: overlap too small"));
  EXPECT_THAT(body, HasSubstr("gave 25 occupied voxels."));
  EXPECT_THAT(body, Not(HasSubstr("covered")));
  EXPECT_THAT(body, Not(ContainsRegex("[ \">(,]-?(nan|inf)[ \"<),]")));
}

TEST(ReportData, FollowsTheLayersOfARecordedRun) {
  const SceneOptions scene{.scene_size = Index3::Constant(9), .enclosure_size = Index3::Constant(3)};
  ObjectModel model(scene, 0.005);
  RunData run;
  run.object = "cube";
  ScanRecord record;
  model.map.set_label({3, 4, 4}, Label::empty);
  model.map.set_label({3, 4, 5}, Label::empty);
  run.add_scan(record, model, nullptr);
  record.scan = 1;
  model.map.add_point({4, 4, 4}, Vec3(1, 0, 0), 1);
  run.add_scan(record, model, nullptr);
  const ReportData data = report_data(run, model.map);
  EXPECT_EQ(data.object, "cube");
  EXPECT_EQ(data.map, &model.map);
  ASSERT_EQ(data.layers.size(), 2U);
  EXPECT_EQ(data.layers[1].first, 1);
  EXPECT_EQ(data.layers[0].second.labels,
            (std::vector<Label>{Label::unmarked, Label::unmarked, Label::unmarked, Label::empty, Label::unmarked,
                                Label::unmarked, Label::unmarked, Label::unmarked, Label::unmarked}));
  EXPECT_EQ(data.layers[1].second.labels, label_layer(model.map, 4).labels);
}

TEST(ReportPage, HoldsTheDataAndTheStaticSections) {
  SmallRun small;
  RunData run;
  run.object = "mug </script>";
  run.candidates = small.data.candidates;
  run.scans.push_back({small.data.scans[0], std::nullopt, {}});
  ObjectModel model(SceneOptions{.scene_size = Index3::Constant(9), .enclosure_size = Index3::Constant(3)}, 0.005);
  run.scans[0].change.labels.resize(27);
  const std::string page = report_page(run, model.map, 12.5);
  EXPECT_THAT(page, HasSubstr("<article class=\"report\">"));
  EXPECT_THAT(page, HasSubstr("<h1>mug &lt;/script&gt;</h1>"));
  EXPECT_THAT(page, HasSubstr("\"format\":\"vantage-run\""));
  EXPECT_THAT(page, Not(HasSubstr("<!--vantage-static-->")));
}

TEST(StaticReport, PrefersTheMeshThenTheCloudThenTheVoxels) {
  SmallRun run;
  EXPECT_EQ(model_scene(run.data).facets.front().finish, PictureScene::Finish::voxel);
  PointCloud cloud;
  cloud.add(Vec3::Zero(), Vec3::UnitZ());
  run.data.cloud = &cloud;
  EXPECT_EQ(model_scene(run.data).discs.size(), 1U);
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  run.data.mesh = &mesh;
  EXPECT_EQ(model_scene(run.data).facets.size(), 1U);
  EXPECT_TRUE(model_scene(run.data).discs.empty());
}

TEST(StaticReport, ViewsShowEveryScanAndTheOtherCandidates) {
  SmallRun run;
  const PictureScene scene = views_scene(run.data);
  EXPECT_EQ(scene.badges.size(), 2U);
  EXPECT_EQ(scene.badges[1].number, 2);
  EXPECT_EQ(scene.dots.size(), 18U);
}

TEST(StaticReport, IsTheSameEveryTime) { EXPECT_TRUE(static_report_html(SmallRun().data) == page_of_small_run()); }

}  // namespace
}  // namespace vantage
