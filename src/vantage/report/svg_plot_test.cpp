#include "vantage/report/svg_plot.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "support/markup.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using ::testing::Contains;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Pointwise;
using ::testing::ThrowsMessage;

LineChart two_lines() {
  return {
      .title = "Coverage",
      .x = {.label = "scan", .ticks = PlotAxis::Ticks::whole},
      .y = {.label = "coverage [%]", .start = PlotAxis::Start::zero},
      .series = {{"a", {0, 1, 2}, {20, 60, 80}, {15, 50, 70}, {25, 70, 90}}, {"b", {0, 1, 2}, {10, 20, 30}, {}, {}}},
      .paper = {{1, 65}}};
}

TEST(Scale, HasRoundTicksAroundTheData) {
  const auto ticks = [](std::vector<double> values, PlotAxis axis, int about) {
    return svg::scale_for(values, axis, about).ticks;
  };
  EXPECT_THAT(ticks({0.3, 9.7}, {}, 5), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(ticks({0.58, 0.69}, {}, 3), Pointwise(DoubleNear(1e-12), {0.55, 0.6, 0.65, 0.7}));
  EXPECT_THAT(ticks({3, 4}, {.label = "", .start = PlotAxis::Start::zero}, 4), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(ticks({0, 1, 2}, {.label = "", .ticks = PlotAxis::Ticks::whole}, 10), ElementsAre(0, 1, 2));
  EXPECT_THAT(ticks({-250, 120}, {}, 4), ElementsAre(-300, -200, -100, 0, 100, 200));
}

TEST(Scale, NumbersOfTicksShowTheStep) {
  EXPECT_EQ(svg::scale_for({0.58, 0.69}, {}, 3).decimals, 2);
  EXPECT_EQ(svg::scale_for({0, 100}, {}, 5).decimals, 0);
}

TEST(Scale, ExistsForNoValuesEqualValuesAndValuesThatAreNone) {
  for (const std::vector<double>& values :
       std::vector<std::vector<double>>{{}, {NAN, INFINITY}, {5, 5}, {0}, {-3}, {1e300}, {1e-300}}) {
    for (const PlotAxis::Start start : {PlotAxis::Start::data, PlotAxis::Start::zero}) {
      const svg::Scale scale = svg::scale_for(values, {.label = "", .start = start}, 5);
      EXPECT_LT(scale.low, scale.high);
      EXPECT_TRUE(std::isfinite(scale.low) && std::isfinite(scale.high));
      EXPECT_LT(scale.ticks.size(), 40U);
      for (const double value : values)
        EXPECT_TRUE(!std::isfinite(value) || (scale.low <= value && value <= scale.high)) << value;
    }
  }
}

TEST(LineChart, PutsPointsWhereTheAxesSay) {
  const LineChart chart = two_lines();
  const svg::PlotArea area = svg::plot_area(chart);
  // x runs from 0 to 2 over the width, y from 0 to 100 over the height.
  EXPECT_DOUBLE_EQ(area.at_x(1), area.left + area.width / 2);
  EXPECT_DOUBLE_EQ(area.at_y(0), area.top + area.height);
  EXPECT_DOUBLE_EQ(area.at_y(60), area.top + 0.4 * area.height);
  const ParsedMarkup svg(svg_plot(chart));
  const auto dots = svg.all("circle", "f0");
  ASSERT_EQ(dots.size(), 4U);  // one in the legend, three on the curve
  EXPECT_NEAR(dots[2]->DoubleAttribute("cx"), area.left + area.width / 2, 0.01);
  EXPECT_NEAR(dots[2]->DoubleAttribute("cy"), area.top + 0.4 * area.height, 0.01);
  EXPECT_EQ(svg.all("path", "band").size(), 1U);
  EXPECT_THAT(svg.texts(), Contains("coverage [%]"));
  EXPECT_THAT(svg.texts(), Contains("paper"));
}

TEST(LineChart, BandRunsAlongBothEndsOfTheInterval) {
  LineChart chart = two_lines();
  chart.paper.clear();
  const svg::PlotArea area = svg::plot_area(chart);
  const ParsedMarkup svg(svg_plot(chart));
  const std::string band = svg.all("path", "band").front()->Attribute("d");
  const auto place = [&](double x, double y) { return svg::number(area.at_x(x)) + " " + svg::number(area.at_y(y)); };
  EXPECT_EQ(band, "M" + place(0, 25) + "L" + place(1, 70) + "L" + place(2, 90) + "L" + place(2, 70) + "L" +
                      place(1, 50) + "L" + place(0, 15) + "z");
}

TEST(LineChart, LeavesAGapWhereAValueIsMissing) {
  LineChart chart{
      .title = "gap", .x = {}, .y = {}, .series = {{"a", {0, 1, 2, 3, 4}, {1, 2, NAN, 2, 1}, {}, {}}}, .paper = {}};
  const ParsedMarkup svg(svg_plot(chart));
  EXPECT_EQ(svg.all("path", "c0").size(), 2U);
  EXPECT_THAT(svg_plot(chart), Not(HasSubstr("nan")));
}

TEST(LineChart, SaysThatThereIsNoData) {
  for (const LineChart& chart :
       {LineChart{}, LineChart{.title = "", .x = {}, .y = {}, .series = {{"a", {1}, {NAN}, {}, {}}}, .paper = {}}}) {
    const ParsedMarkup svg(svg_plot(chart));
    EXPECT_THAT(svg.texts(), Contains("no data"));
  }
}

TEST(LineChart, RefusesLengthsThatDoNotAgree) {
  LineChart chart = two_lines();
  chart.series[1].x.pop_back();
  EXPECT_THAT([&] { static_cast<void>(svg_plot(chart)); },
              ThrowsMessage<InputError>(HasSubstr("plot series 'b' has 2 values of x: must have 3")));
}

TEST(Plots, EscapeWhatPeopleWrite) {
  const std::string nasty = "<b> & \"q\" 'a' \x01";
  LineChart chart = two_lines();
  chart.title = chart.x.label = chart.series[0].name = nasty;
  const ParsedMarkup svg(svg_plot(chart));
  EXPECT_THAT(svg.texts(), Contains("<b> & \"q\" 'a' ?").Times(3));
}

TEST(BarChart, DrawsBarsToTheirValues) {
  BarChart chart;
  chart.categories = {"mug", "bunny"};
  chart.series = {{"ours", {4, 8}, {3, 7}, {5, 9}, {5, NAN}}, {"theirs", {2, NAN}, {}, {}, {}}};
  const svg::PlotArea area = svg::plot_area(chart);
  const ParsedMarkup svg(svg_plot(chart));
  const auto bars = svg.all("rect", "bar");
  ASSERT_EQ(bars.size(), 3U);
  EXPECT_NEAR(bars[0]->DoubleAttribute("height"), area.height * 4 / area.y.high, 0.01);
  EXPECT_NEAR(bars[2]->DoubleAttribute("y"), area.at_y(8), 0.01);
  EXPECT_NEAR(bars[2]->DoubleAttribute("x"), area.left + area.width / 2 * (1 + 0.14), 0.01);
  EXPECT_EQ(svg.all("line", "whisker").size(), 6U);
  EXPECT_EQ(svg.all("path", "paper").size(), 2U);  // the legend's and one on a bar
}

TEST(BarChart, StacksBarsOnEachOther) {
  BarChart chart;
  chart.categories = {"0"};
  chart.series = {{"plan", {30}, {}, {}, {}}, {"scan", {NAN}, {}, {}, {}}, {"merge", {10}, {}, {}, {}}};
  chart.arrangement = BarChart::Arrangement::stacked;
  const svg::PlotArea area = svg::plot_area(chart);
  const ParsedMarkup svg(svg_plot(chart));
  const auto bars = svg.all("rect", "bar");
  ASSERT_EQ(bars.size(), 2U);
  EXPECT_NEAR(bars[1]->DoubleAttribute("y"), area.at_y(40), 0.01);
  EXPECT_NEAR(bars[1]->DoubleAttribute("y") + bars[1]->DoubleAttribute("height"), bars[0]->DoubleAttribute("y"), 0.02);
}

TEST(Readable, SetsNumbersForPeople) {
  EXPECT_EQ(readable(1234), "1234");
  EXPECT_EQ(readable(1234567), "1\u2009234\u2009567");
  EXPECT_EQ(readable(-12345.678, 1), "−12\u2009345.7");
  EXPECT_EQ(readable(-0.0004, 2), "0.00");
  EXPECT_EQ(readable(NAN), "–");
}

TEST(StandaloneSvg, CarriesItsStyleAndNamespace) {
  const std::string file = standalone_svg(svg_plot(two_lines()));
  const ParsedMarkup svg(file);
  ASSERT_EQ(svg.all("svg").size(), 1U);
  EXPECT_STREQ(svg.all("svg").front()->Attribute("xmlns"), "http://www.w3.org/2000/svg");
  EXPECT_EQ(svg.all("style").size(), 1U);
}

TEST(Colors, OfTheScaleGrowLighterAndKeepToTheirEnds) {
  const auto lightness = [](const Color& c) { return 0.2126 * c.red + 0.7152 * c.green + 0.0722 * c.blue; };
  for (int i = 0; i < 50; ++i)
    EXPECT_LT(lightness(sequential_color(i / 50.0)), lightness(sequential_color((i + 1) / 50.0)));
  EXPECT_EQ(css(sequential_color(-3)), "#440154");
  EXPECT_EQ(css(sequential_color(7)), "#fde725");
  EXPECT_EQ(sequential_color(NAN), palette::no_value);
}

}  // namespace
}  // namespace vantage
