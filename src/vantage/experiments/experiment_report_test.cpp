#include "vantage/experiments/experiment_report.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/markup.hpp"
#include "vantage/core/error.hpp"
#include "vantage/report/report.hpp"

namespace vantage {
namespace {

using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

ExperimentTable small_table() {
  Estimate views = estimate({8, 9, 10});
  views.published = 8;
  views.band_low = 5;
  views.band_high = 8.5;
  Estimate saved = estimate({-0.5});
  saved.band_high = 0;
  return {.name = "table1",
          .title = "Views, <all> objects",
          .note = "",
          .columns = {{"views", 1}, {"saved [m]", 2, ExperimentTable::Column::Kind::difference}, {"remark, if any", 0}},
          .rows = {{"mug", {views, saved, std::string("a \"good\" one")}},
                   {"bunny", {std::monostate(), saved, std::monostate()}}}};
}

ExperimentFigure small_figure() {
  LineChart lines{.title = "coverage",
                  .x = {.label = "scan"},
                  .y = {.label = "coverage [%]"},
                  .series = {{"ours", {0, 1}, {50, NAN}, {45, NAN}, {55, NAN}}},
                  .paper = {{1, 90}}};
  BarChart bars;
  bars.title = "views, all";
  bars.categories = {"mug"};
  bars.series = {{"ours", {8}, {7}, {9}, {7.5}}};
  const GridValues grid{.columns = 2,
                        .rows = 1,
                        .values = {1, NAN},
                        .x_low = -1,
                        .x_high = 1,
                        .x_label = "",
                        .y_label = "",
                        .value_label = "utility",
                        .value_low = {},
                        .value_high = {}};
  SphereMap sphere{.title = "sphere", .directions = {{2, 0, 0}}, .values = {3}, .chosen = {}, .value_label = "utility"};
  return {"figure10",
          "All kinds",
          "Bands: 95 %.",
          {lines, bars, HeatMap{"plane", grid}, SurfacePlot{"surface", grid}, sphere}};
}

TEST(ExperimentReport, PageIsWellFormedAndNeedsNothingElse) {
  const std::string page =
      html(ExperimentReport{"Tables & figures", "vantage 0", {"Text with <signs>."}, {small_table(), small_figure()}});
  const ParsedMarkup parsed(page);
  EXPECT_EQ(parsed.all("svg").size(), 5U);
  EXPECT_EQ(parsed.all("table").size(), 1U);
  EXPECT_TRUE(parsed.all("script").empty());
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, Not(ContainsRegex("[ \">(,]-?(nan|inf)[ \"<),]")));
  EXPECT_THAT(page, HasSubstr("Text with &lt;signs&gt;."));
  EXPECT_THAT(page, HasSubstr("<td class=\"r outside\">9.0 ± 1.0</td><td class=\"r reference\">8.0</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"r inside\">−0.50 [−0.50, −0.50]</td>"));
  EXPECT_THAT(page, HasSubstr("Table 1. Views, &lt;all&gt; objects"));
  EXPECT_THAT(page, HasSubstr("Figure 1. All kinds. Bands: 95 %."));
}

TEST(ExperimentReport, WritesEveryNumberOfATableAsCsv) {
  // t(2) = 4.302653, so the interval of 8, 9, 10 is 9 -+ 4.302653 / sqrt(3).
  const std::string text = csv(small_table());
  const std::size_t second = text.find('\n') + 1;
  EXPECT_EQ(text.substr(0, second),
            "object,views: mean,views: sd,views: runs,views: low,views: high,views: paper,views: band_low,views: "
            "band_high,views: in_band,"
            "saved [m]: mean,saved [m]: sd,saved [m]: runs,saved [m]: low,saved [m]: high,saved [m]: paper,saved [m]: "
            "band_low,saved [m]: band_high,saved [m]: in_band,"
            "\"remark, if any\"\n");
  EXPECT_THAT(text.substr(second), ContainsRegex("^mug,9,1,3,6\\.5158[0-9]*,11\\.484[0-9]*,8,5,8\\.5,0,-0\\.5,0,1,-0\\."
                                                 "5,-0\\.5,,,0,1,\"a \"\"good\"\" one\"\n"));
  EXPECT_THAT(text, HasSubstr("\nbunny,,,,,,,,,,-0.5,0,1,-0.5,-0.5,,,0,1,\n"));
}

TEST(ExperimentReport, WritesEveryPointOfAFigureAsCsv) {
  EXPECT_EQ(csv(small_figure()),
            "plot,series,x,y,value,low,high\n"
            "coverage,ours,0,,50,45,55\n"
            "coverage,ours,1,,,,\n"
            "coverage,paper,1,,90,,\n"
            "\"views, all\",ours,mug,,8,7,9\n"
            "\"views, all\",paper ours,mug,,7.5,,\n"
            "plane,utility,-0.5,0.5,1,,\n"
            "plane,utility,0.5,0.5,,,\n"
            "surface,utility,-0.5,0.5,1,,\n"
            "surface,utility,0.5,0.5,,,\n"
            "sphere,utility,90,0,3,,\n");
}

TEST(ExperimentReport, WritesTheDocumentOfTheViewer) {
  const auto document = json(ExperimentReport{"Title", "vantage 0", {"One."}, {small_table(), small_figure()}});
  EXPECT_EQ(document["format"], "vantage-experiment");
  EXPECT_EQ(document["version"], 1);
  const auto& table = document["tables"][0];
  EXPECT_EQ(table["columns"].dump(),
            R"(["object","views","± sd","paper","saved [m]","95 % interval","paper","remark, if any"])");
  EXPECT_EQ(table["rows"][0].dump(), R"(["mug",9.0,1.0,8.0,-0.5,"[−0.50, −0.50]",null,"a \"good\" one"])");
  EXPECT_EQ(table["rows"][1].dump(), R"(["bunny",null,null,null,-0.5,"[−0.50, −0.50]",null,null])");
  EXPECT_EQ(table["paper_columns"].dump(), "[3,6]");
  EXPECT_EQ(table["estimates"][0][0]["runs"], 3);
  EXPECT_EQ(table["estimates"][0][0]["in_band"], false);
  EXPECT_TRUE(table["estimates"][1][0].is_null());
  ASSERT_EQ(document["figures"].size(), 5U);
  EXPECT_EQ(document["figures"][0]["kind"], "lines");
  EXPECT_EQ(document["figures"][0]["series"][0]["y"].dump(), "[50.0,null]");
  EXPECT_EQ(document["figures"][0]["series"][1]["paper"], true);
  EXPECT_EQ(document["figures"][1]["kind"], "bars");
  EXPECT_EQ(document["figures"][1]["categories"].dump(), R"(["mug"])");
  EXPECT_EQ(document["figures"][1]["series"][0].dump(), R"({"name":"ours","y":[8.0],"low":[7.0],"high":[9.0]})");
  EXPECT_EQ(document["figures"][1]["series"][1].dump(), R"({"name":"paper ours","y":[7.5],"paper":true})");
  EXPECT_EQ(document["figures"][2]["kind"], "heat");
  EXPECT_EQ(document["figures"][3]["kind"], "surface");
  EXPECT_EQ(document["figures"][3]["values"].dump(), "[1.0,null]");
  EXPECT_EQ(document["figures"][3]["x"].dump(), "[-1.0,1.0]");
  EXPECT_EQ(document["figures"][4]["kind"], "sphere");
  EXPECT_EQ(document["figures"][4]["directions"].dump(), "[[1.0,0.0,0.0]]");
}

TEST(ExperimentReport, KeepsTimesApart) {
  ExperimentTable times = small_table();
  times.content = ExperimentContent::times;
  const ExperimentReport report{"Title", "vantage 0", {}, {small_table(), times, small_figure()}};
  EXPECT_EQ(only(report, ExperimentContent::results).parts.size(), 2U);
  EXPECT_EQ(only(report, ExperimentContent::times).parts.size(), 1U);
}

TEST(ExperimentReport, NamesTheRowThatDoesNotFit) {
  ExperimentTable table = small_table();
  table.rows[1].cells.pop_back();
  EXPECT_THAT(
      [&] {
        static_cast<void>(html(ExperimentReport{"", "", {}, {table}}));
      },
      ThrowsMessage<InputError>(HasSubstr("table table1, row 'bunny' has 2 cells: must have 3")));
}

TEST(ExperimentPage, HoldsEveryPlotForThePageAndForReadersWithoutScript) {
  const std::string page =
      experiment_page({.title = "all", .program = "vantage", .text = {}, .parts = {small_figure()}});
  const auto document = document_of_page(page, "page");
  ASSERT_TRUE(document.has_value());
  EXPECT_EQ((*document)["format"], "vantage-experiment");
  const auto& figures = (*document)["figures"];
  ASSERT_EQ(figures.size(), 5U);
  EXPECT_EQ(figures[0]["title"], "coverage");
  EXPECT_EQ(figures[0]["series"][1]["name"], "paper");
  for (std::size_t i = 1; i < 5; ++i) EXPECT_THAT(figures[i]["svg"].get<std::string>(), HasSubstr("<svg")) << i;
  EXPECT_EQ(figures[4]["title"], "sphere");
  for (const auto& figure : figures) EXPECT_EQ(figure["figure"], "All kinds");
  EXPECT_THAT((*document)["svg_style"].get<std::string>(), HasSubstr(".plot"));
  EXPECT_THAT(page, HasSubstr("<h1>all</h1>"));
}

}  // namespace
}  // namespace vantage
