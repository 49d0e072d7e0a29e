#include "vantage/report/svg_map.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "support/markup.hpp"
#include "vantage/core/error.hpp"
#include "vantage/core/random.hpp"
#include "vantage/report/label_colors.hpp"

namespace vantage {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

GridValues grid3x2() {
  return {.columns = 3,
          .rows = 2,
          .values = {0, 1, 2, 3, NAN, 5},
          .x_label = "x [m]",
          .y_label = "y [m]",
          .value_label = "utility",
          .value_low = {},
          .value_high = {}};
}

TEST(HeatMap, ShowsACellPerValue) {
  const std::string svg = svg_plot(HeatMap{.title = "map", .grid = grid3x2()});
  const ParsedMarkup parsed(svg);
  ASSERT_EQ(parsed.all("image").size(), 1U);
  EXPECT_THAT(parsed.all("image").front()->Attribute("href"), HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(parsed.texts(), Contains("utility"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(SurfacePlot, LeavesOutFacesWithoutValue) {
  GridValues grid = grid3x2();
  const ParsedMarkup holed(svg_plot(SurfacePlot{.title = "surface", .grid = grid}));
  EXPECT_EQ(holed.all("path", "edge").size(), 0U);  // both faces touch the missing value
  grid.values[4] = 4;
  const ParsedMarkup full(svg_plot(SurfacePlot{.title = "surface", .grid = grid}));
  EXPECT_EQ(full.all("path", "edge").size(), 2U);
}

TEST(GridValues, NameWhatIsWrong) {
  GridValues grid = grid3x2();
  grid.values.pop_back();
  EXPECT_THAT([&] { static_cast<void>(svg_plot(HeatMap{.title = "", .grid = grid})); },
              ThrowsMessage<InputError>(HasSubstr("grid of 3x2 values holds 5")));
  grid = grid3x2();
  grid.x_high = grid.x_low;
  EXPECT_THAT([&] { static_cast<void>(svg_plot(SurfacePlot{.title = "", .grid = grid})); },
              ThrowsMessage<InputError>(HasSubstr("the low end must be below")));
}

TEST(Mollweide, KeepsAreas) {
  // Equal shares of the sphere take equal shares of the ellipse, whose area is 2 pi.
  Random random(5);
  int north_of_30 = 0, ellipse_part = 0;
  const double border = svg::mollweide(Vec3(0, -std::cos(radians(30)), std::sin(radians(30)))).y;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const svg::MapPoint point = svg::mollweide(random.unit_vector());
    ASSERT_LE(point.x * point.x / 4 + point.y * point.y, 1 + 1e-9);
    north_of_30 += point.y > border ? 1 : 0;
    ellipse_part += std::abs(point.x) < 1 && std::abs(point.y) < 0.5 ? 1 : 0;
  }
  EXPECT_NEAR(north_of_30, count * 0.25, 4 * std::sqrt(count * 0.25 * 0.75));  // (1 - sin 30) / 2 of the sphere
  const double share = 2 * 1 / (2 * std::numbers::pi);                         // of the box |x| < 1, |y| < 1/2
  EXPECT_NEAR(ellipse_part, count * share, 4 * std::sqrt(count * share * (1 - share)));
}

TEST(Mollweide, PutsTheAxesWhereTheMapSays) {
  const auto expect_at = [](const Vec3& direction, double x, double y) {
    const svg::MapPoint point = svg::mollweide(direction);
    EXPECT_NEAR(point.x, x, 1e-6);
    EXPECT_NEAR(point.y, y, 1e-6);
  };
  expect_at({0, -3, 0}, 0, 0);
  expect_at({1, 0, 0}, 1, 0);
  expect_at({-2, 0, 0}, -1, 0);
  expect_at({0, 0, 1}, 0, 1);
  expect_at({0, 0, -1}, 0, -1);
}

TEST(SphereMap, MarksTheChosenViewAndThoseWithoutValue) {
  SphereMap map{.title = "views",
                .directions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                .values = {1, NAN, 3},
                .chosen = 2,
                .value_label = "utility"};
  const ParsedMarkup svg(svg_plot(map));
  EXPECT_EQ(svg.all("circle").size(), 4U);
  EXPECT_EQ(svg.all("circle", "frame").size(), 1U);
  EXPECT_EQ(svg.all("circle", "paper").size(), 1U);
  map.values.pop_back();
  EXPECT_THAT([&] { static_cast<void>(svg_plot(map)); },
              ThrowsMessage<InputError>(HasSubstr("3 directions and 2 values")));
}

TEST(LabelSlice, FillsTheAreaOfEachLabel) {
  VoxelMap map(SceneOptions{.scene_size = Index3::Constant(9), .enclosure_size = Index3::Constant(5)});
  map.set_label({2, 2, 4}, Label::empty);
  map.set_label({3, 2, 4}, Label::empty);
  map.add_point({4, 2, 4}, Vec3(1, 0, 0), 1);
  map.set_label({6, 6, 4}, Label::occluded);
  map.add_point({5, 5, 3}, Vec3(1, 0, 0), 1);  // in another layer
  const LabelSlice slice{.title = "slice", .layer = label_layer(map, 4)};
  EXPECT_NEAR(slice.layer.box.sizes().z(), 0.02, 1e-12);
  const ParsedMarkup svg(svg_plot(slice));
  EXPECT_THAT(svg.texts(), Contains("empty 2"));
  EXPECT_THAT(svg.texts(), Contains("occupied 1"));
  EXPECT_THAT(svg.texts(), Contains("unmarked 21"));
  EXPECT_THAT(svg.texts(), Contains("occplane 0"));
  const auto path_of = [&](Label label) {
    for (const auto* path : svg.all("path"))
      if (path->Attribute("fill", css(label_color(label)).c_str()) != nullptr) return std::string(path->Attribute("d"));
    return std::string();
  };
  // y points up: the row of least y is the lowest of five, x counts from the left.
  EXPECT_EQ(path_of(Label::empty), "M0 4h2v1H0z");
  EXPECT_EQ(path_of(Label::occupied), "M2 4h1v1H2z");
  EXPECT_EQ(path_of(Label::occluded), "M4 0h1v1H4z");
  EXPECT_EQ(path_of(Label::occplane), "");
}

TEST(LabelSlice, StaysInTheEnclosure) {
  VoxelMap map(SceneOptions{.scene_size = Index3::Constant(9), .enclosure_size = Index3::Constant(5)});
  EXPECT_THAT([&] { static_cast<void>(label_layer(map, 7)); },
              ThrowsMessage<InputError>(HasSubstr("slice z = 7: must lie in the enclosure, 2 to 6")));
  EXPECT_EQ(middle_layer(map), 4);
  map.add_point({3, 3, 6}, Vec3::Zero(), 0);
  map.add_point({3, 4, 5}, Vec3::Zero(), 0);
  map.add_point({3, 5, 5}, Vec3::Zero(), 0);
  EXPECT_EQ(middle_layer(map), 5);
}

}  // namespace
}  // namespace vantage
