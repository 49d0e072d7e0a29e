#include "vantage/report/svg_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vantage/core/error.hpp"
#include "vantage/report/picture.hpp"

namespace vantage {
namespace {

using svg::number;
using svg::title_height;

svg::Scale value_scale(const std::vector<double>& values, std::optional<double> low, std::optional<double> high) {
  std::vector<double> ends = values;
  if (low && high) ends = {*low, *high};
  svg::Scale scale = svg::scale_for(ends, {}, 4);
  if (low) scale.low = *low;
  if (high) scale.high = *high;
  std::erase_if(scale.ticks, [&](double tick) { return tick < scale.low - 1e-9 || tick > scale.high + 1e-9; });
  return scale;
}

Color color_of(double value, const svg::Scale& scale) {
  return sequential_color((value - scale.low) / (scale.high - scale.low));
}

/// A standing scale of colours, 12 px wide.
std::string color_bar(double x, double top, double height, const svg::Scale& scale, const std::string& label) {
  constexpr int steps = 40;
  std::string drawing;
  for (int i = 0; i < steps; ++i)
    drawing += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"12\" height=\"{}\" fill=\"{}\"/>\n", number(x),
                           number(top + height * (steps - 1 - i) / steps), number(height / steps + 0.4),
                           css(sequential_color((i + 0.5) / steps)));
  for (const double tick : scale.ticks) {
    const double y = top + height * (1 - (tick - scale.low) / (scale.high - scale.low));
    drawing += svg::line(x + 12, y, x + 15, y, "axis") +
               svg::text(x + 18, y + 4, readable(tick, scale.decimals), svg::Anchor::start, "tick");
  }
  return drawing + svg::text(x + 12, top - 9, label, svg::Anchor::middle, "note");
}

std::string title_of(const std::string& title) { return svg::text(8, 16, title, svg::Anchor::start, "name"); }

double tick_room(const svg::Scale& scale) {
  double widest = 0;
  for (const double tick : scale.ticks) widest = std::max(widest, svg::text_width(readable(tick, scale.decimals)));
  return widest;
}

svg::Scale fixed_scale(double low, double high, double pixels) {
  svg::Scale scale = svg::scale_for({low, high}, {}, static_cast<int>(pixels / 60));
  scale.low = low;
  scale.high = high;
  std::erase_if(scale.ticks, [&](double tick) { return tick < low - 1e-9 || tick > high + 1e-9; });
  return scale;
}

}  // namespace

void GridValues::validate() const {
  require(columns > 0 && rows > 0, "grid of ", columns, "x", rows, " values: both sides must be positive");
  require(values.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), "grid of ", columns, "x",
          rows, " values holds ", values.size());
  require(x_low < x_high && y_low < y_high, "grid of values over [", x_low, ", ", x_high, "] x [", y_low, ", ", y_high,
          "]: the low end must be below the high one");
}

std::string svg_plot(const HeatMap& map) {
  const GridValues& grid = map.grid;
  grid.validate();
  const svg::Scale values = value_scale(grid.values, grid.value_low, grid.value_high);
  svg::PlotArea area;
  const double right = 40 + tick_room(values);
  area.top = title_height + 22;
  area.height = map.height - area.top - 44;
  area.y = fixed_scale(grid.y_low, grid.y_high, area.height);
  area.left = tick_room(area.y) + (grid.y_label.empty() ? 14 : 32);
  area.width = map.width - area.left - right;
  area.x = fixed_scale(grid.x_low, grid.x_high, area.width);

  Picture cells{grid.columns, grid.rows, {}};  // one pixel per cell, drawn large: thousands of cells stay small
  for (int row = grid.rows - 1; row >= 0; --row)
    for (int column = 0; column < grid.columns; ++column) {
      const Color color = color_of(grid.values[static_cast<std::size_t>(row * grid.columns + column)], values);
      for (const double channel : {color.red, color.green, color.blue})
        cells.rgb.push_back(static_cast<std::uint8_t>(std::lround(channel * 255)));
    }
  std::string drawing = title_of(map.title) + area.axes({.label = grid.x_label}, {.label = grid.y_label});
  drawing += fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
      "style=\"image-rendering:pixelated\" "
      "href=\"{}\"/>\n",
      number(area.left), number(area.top), number(area.width), number(area.height), png_data_uri(cells));
  drawing += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", number(area.left),
                         number(area.top), number(area.width), number(area.height));
  drawing += color_bar(area.right() + 12, area.top, area.height, values, grid.value_label);
  return svg::picture(map.width, map.height, map.title, drawing);
}

std::string svg_plot(const SurfacePlot& plot) {
  const GridValues& grid = plot.grid;
  grid.validate();
  const svg::Scale values = value_scale(grid.values, grid.value_low, grid.value_high);
  const double right = 46 + tick_room(values), width = plot.width - right - 12;
  // Dimetric: x runs down to the right, y up to the right, height straight up.
  const double top = title_height + 22, rise = (plot.height - top) * 0.42, floor_top = top + rise;
  const double floor_height = plot.height - floor_top - 26;
  const auto place = [&](double x, double y, double share) {
    return svg::MapPoint{12 + width * (x + y) / 2, floor_top + floor_height * (1 + x - y) / 2 - rise * share};
  };
  const auto share_of = [&](double value) {
    return std::clamp((value - values.low) / (values.high - values.low), 0.0, 1.0);
  };
  std::string drawing = title_of(plot.title);
  const auto outline = [&](std::initializer_list<svg::MapPoint> corners) {
    std::string path;
    for (const svg::MapPoint& corner : corners)
      path += fmt::format("{}{} {}", path.empty() ? "M" : "L", number(corner.x), number(corner.y));
    return path + "z";
  };
  drawing += fmt::format("<path class=\"frame\" d=\"{}\"/>\n",
                         outline({place(0, 0, 0), place(1, 0, 0), place(1, 1, 0), place(0, 1, 0)}));
  const auto value = [&](int column, int row) {
    return grid.values[static_cast<std::size_t>(row * grid.columns + column)];
  };
  const auto along = [](int k, int count) { return count > 1 ? static_cast<double>(k) / (count - 1) : 0.5; };
  for (int row = grid.rows - 2; row >= 0; --row)  // far to near
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const double a = value(column, row), b = value(column + 1, row), c = value(column + 1, row + 1),
                   d = value(column, row + 1);
      const double mean = (a + b + c + d) / 4;
      if (!std::isfinite(mean)) continue;
      const double x0 = along(column, grid.columns), x1 = along(column + 1, grid.columns);
      const double y0 = along(row, grid.rows), y1 = along(row + 1, grid.rows);
      drawing += fmt::format("<path class=\"edge\" fill=\"{}\" d=\"{}\"/>\n", css(color_of(mean, values)),
                             outline({place(x0, y0, share_of(a)), place(x1, y0, share_of(b)),
                                      place(x1, y1, share_of(c)), place(x0, y1, share_of(d))}));
    }
  const svg::MapPoint x_middle = place(0.5, 0, 0), y_middle = place(1, 0.5, 0);
  drawing += svg::text(x_middle.x - 10, x_middle.y + 20, grid.x_label, svg::Anchor::end, "note") +
             svg::text(y_middle.x + 10, y_middle.y + 20, grid.y_label, svg::Anchor::start, "note");
  drawing += color_bar(plot.width - right + 6, top, plot.height - top - 40, values, grid.value_label);
  return svg::picture(plot.width, plot.height, plot.title, drawing);
}

svg::MapPoint svg::mollweide(const Vec3& direction) {
  const Vec3 d = direction.normalized();
  const double latitude = std::asin(std::clamp(d.z(), -1.0, 1.0)), longitude = std::atan2(d.x(), -d.y());
  double theta = latitude;  // 2 theta + sin 2 theta = pi sin(latitude), by Newton's method
  for (int i = 0; i < 60 && std::abs(std::abs(latitude) - std::numbers::pi / 2) > 1e-9; ++i)
    theta -= (2 * theta + std::sin(2 * theta) - std::numbers::pi * std::sin(latitude)) / (2 + 2 * std::cos(2 * theta));
  return {2 * longitude / std::numbers::pi * std::cos(theta), std::sin(theta)};
}

std::string svg_plot(const SphereMap& map) {
  require(map.directions.size() == map.values.size(), "sphere map has ", map.directions.size(), " directions and ",
          map.values.size(), " values: must be as many");
  const svg::Scale values = value_scale(map.values, std::nullopt, std::nullopt);
  const double right = 50 + tick_room(values), top = title_height + 16;
  const double half_height = std::min((map.height - top - 18) / 2, (map.width - right - 30) / 4);
  const double middle_x = (map.width - right) / 2, middle_y = top + half_height;
  const auto place = [&](const Vec3& direction) {
    const svg::MapPoint point = svg::mollweide(direction);
    return svg::MapPoint{middle_x + half_height * point.x, middle_y - half_height * point.y};
  };
  std::string drawing = title_of(map.title);
  drawing += fmt::format("<ellipse class=\"frame\" cx=\"{}\" cy=\"{}\" rx=\"{}\" ry=\"{}\"/>\n", number(middle_x),
                         number(middle_y), number(2 * half_height), number(half_height));
  const auto grid_line = [&](auto direction_at) {
    std::string path;
    for (int i = 0; i <= 60; ++i) {
      const svg::MapPoint point = place(direction_at(i / 60.0));
      path += fmt::format("{}{} {}", path.empty() ? "M" : "L", number(point.x), number(point.y));
    }
    drawing += fmt::format("<path class=\"grid\" fill=\"none\" d=\"{}\"/>\n", path);
  };
  const auto toward = [](double longitude, double latitude) {
    return Vec3(std::sin(longitude) * std::cos(latitude), -std::cos(longitude) * std::cos(latitude),
                std::sin(latitude));
  };
  constexpr double almost_pi = std::numbers::pi * 0.99999;
  for (const double latitude : {-60.0, -30.0, 0.0, 30.0, 60.0})
    grid_line([&](double t) { return toward(almost_pi * (2 * t - 1), radians(latitude)); });
  for (const double longitude : {-90.0, 0.0, 90.0})
    grid_line([&](double t) { return toward(radians(longitude), almost_pi / 2 * (2 * t - 1)); });
  constexpr std::pair<const char*, int> sides[] = {{"−x", -90}, {"−y", 0}, {"+x", 90}};
  for (const auto& [name, longitude] : sides) {
    const svg::MapPoint at = place(toward(radians(longitude), 0));
    drawing += svg::text(at.x, middle_y + half_height + 15, name, svg::Anchor::middle, "tick");
  }
  drawing += svg::text(middle_x, top - 4, "+z", svg::Anchor::middle, "tick");
  const double radius = std::clamp(half_height * 1.1 / std::sqrt(static_cast<double>(map.values.size()) + 1), 1.2, 9.0);
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const svg::MapPoint at = place(map.directions[i]);
    const bool known = std::isfinite(map.values[i]);
    drawing +=
        fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", number(at.x), number(at.y), number(radius),
                    known ? fmt::format("fill=\"{}\"", css(color_of(map.values[i], values))) : "class=\"frame\"");
  }
  if (map.chosen && *map.chosen < map.directions.size()) {
    const svg::MapPoint at = place(map.directions[*map.chosen]);
    drawing += fmt::format("<circle class=\"paper\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", number(at.x), number(at.y),
                           number(radius + 3));
  }
  drawing += color_bar(map.width - right + 10, top + 6, 2 * half_height - 12, values, map.value_label);
  return svg::picture(map.width, map.height, map.title, drawing);
}

}  // namespace vantage
