#include "vantage/report/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using svg::number;
using svg::title_height;

constexpr double axis_height = 44, right_margin = 14;

void require_length(std::size_t length, std::size_t wanted, const std::string& series, const char* what) {
  require(length == wanted, "plot series '", series, "' has ", length, " values of ", what, ": must have ", wanted);
}

void validate(const LineChart& chart) {
  for (const LineSeries& series : chart.series) {
    require_length(series.x.size(), series.y.size(), series.name, "x");
    if (!series.low.empty()) require_length(series.low.size(), series.y.size(), series.name, "low");
    require_length(series.high.size(), series.low.size(), series.name, "high");
  }
}

void validate(const BarChart& chart) {
  for (const BarSeries& series : chart.series) {
    require_length(series.value.size(), chart.categories.size(), series.name, "value");
    if (!series.low.empty()) require_length(series.low.size(), series.value.size(), series.name, "low");
    require_length(series.high.size(), series.low.size(), series.name, "high");
    if (!series.paper.empty()) require_length(series.paper.size(), series.value.size(), series.name, "paper");
  }
}

const std::string paper_sign = "<path class=\"paper\" d=\"M0-5 5 0 0 5-5 0z\"/>";

std::string paper_mark(double x, double y) {
  return fmt::format("<g transform=\"translate({} {})\">{}</g>\n", number(x), number(y), paper_sign);
}

std::vector<svg::LegendEntry> legend_of(const LineChart& chart) {
  std::vector<svg::LegendEntry> entries;
  for (std::size_t k = 0; k < chart.series.size(); ++k)
    entries.push_back(
        {chart.series[k].name,
         fmt::format("<path class=\"curve c{}\" d=\"M-11 0h22\"/>", k % series_styles) + svg::mark(0, 0, k)});
  if (!chart.paper.empty()) entries.push_back({"paper", paper_sign});
  if (entries.size() == 1 && chart.series.size() == 1) entries.clear();  // the axis says it
  return entries;
}

std::vector<svg::LegendEntry> legend_of(const BarChart& chart) {
  std::vector<svg::LegendEntry> entries;
  bool paper = false;
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    entries.push_back(
        {chart.series[k].name,
         fmt::format("<rect class=\"f{}\" x=\"-8\" y=\"-6\" width=\"16\" height=\"12\"/>", k % series_styles)});
    paper = paper || !chart.series[k].paper.empty();
  }
  if (entries.size() == 1) entries.clear();
  if (paper) entries.push_back({"paper", paper_sign});
  return entries;
}

/// The area below title and legend and beside the numbers of the y axis.
svg::PlotArea area_of(double width, double height, const std::vector<svg::LegendEntry>& legend, const svg::Scale& x,
                      const svg::Scale& y, bool has_y_label) {
  double numbers = 0;
  for (const double tick : y.ticks) numbers = std::max(numbers, svg::text_width(readable(tick, y.decimals)));
  svg::PlotArea area;
  area.x = x;
  area.y = y;
  area.left = numbers + (has_y_label ? 32 : 14);
  area.top = title_height + 8 + svg::legend_row_height * svg::legend_rows(width - area.left - right_margin, legend);
  area.width = width - area.left - right_margin;
  area.height = height - area.top - axis_height;
  return area;
}

std::string header(const std::string& title, const svg::PlotArea& area, const std::vector<svg::LegendEntry>& legend) {
  return svg::text(area.left, 16, title, svg::Anchor::start, "name") +
         svg::legend(area.left, title_height + 14, area.width, legend);
}

/// The stretches of a series without a gap, each as "x y" points.
std::vector<std::vector<std::size_t>> stretches(const LineSeries& series) {
  std::vector<std::vector<std::size_t>> all(1);
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    const bool drawn = std::isfinite(series.x[i]) && std::isfinite(series.y[i]);
    if (drawn) all.back().push_back(i);
    if (!drawn && !all.back().empty()) all.emplace_back();
  }
  if (all.back().empty()) all.pop_back();
  return all;
}

std::string curve(const svg::PlotArea& area, const LineSeries& series, std::size_t k) {
  std::string bands, lines, marks;
  for (const std::vector<std::size_t>& stretch : stretches(series)) {
    std::string path, upper, lower;
    for (const std::size_t i : stretch) {
      const std::string x = number(area.at_x(series.x[i]));
      path += fmt::format("{}{} {}", path.empty() ? "M" : "L", x, number(area.at_y(series.y[i])));
      marks += svg::mark(area.at_x(series.x[i]), area.at_y(series.y[i]), k);
      if (series.low.empty() || !std::isfinite(series.low[i]) || !std::isfinite(series.high[i])) continue;
      upper += fmt::format("{}{} {}", upper.empty() ? "M" : "L", x, number(area.at_y(series.high[i])));
      lower.insert(0, fmt::format("L{} {}", x, number(area.at_y(series.low[i]))));
    }
    if (!upper.empty())
      bands += fmt::format("<path class=\"band f{}\" d=\"{}{}z\"/>\n", k % series_styles, upper, lower);
    lines += fmt::format("<path class=\"curve c{}\" d=\"{}\"/>\n", k % series_styles, path);
  }
  return bands + lines + (series.y.size() <= 60 ? marks : "");
}

std::string bar(double x, double width, double y_from, double y_to, std::size_t k) {
  return fmt::format("<rect class=\"bar f{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", k % series_styles,
                     number(x), number(std::min(y_from, y_to)), number(width), number(std::abs(y_to - y_from)));
}

std::string stacked_bars(const BarChart& chart, const svg::PlotArea& area, std::size_t category, double left,
                         double width) {
  std::string drawing;
  double sum = 0;
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    const double value = chart.series[k].value[category];
    if (!std::isfinite(value)) continue;
    drawing += bar(left, width, area.at_y(sum), area.at_y(sum + value), k);
    sum += value;
  }
  return drawing;
}

std::string grouped_bars(const BarChart& chart, const svg::PlotArea& area, std::size_t category, double left,
                         double width) {
  std::string drawing;
  const double bar_width = width / static_cast<double>(chart.series.size());
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    const BarSeries& series = chart.series[k];
    const double x = left + bar_width * static_cast<double>(k), middle = x + bar_width / 2;
    const double base = std::clamp(0.0, area.y.low, area.y.high);
    if (std::isfinite(series.value[category]))
      drawing += bar(x, bar_width, area.at_y(base), area.at_y(series.value[category]), k);
    if (!series.low.empty() && std::isfinite(series.low[category]) && std::isfinite(series.high[category])) {
      const double low = area.at_y(series.low[category]), high = area.at_y(series.high[category]);
      drawing += svg::line(middle, low, middle, high, "whisker") +
                 svg::line(middle - 3, low, middle + 3, low, "whisker") +
                 svg::line(middle - 3, high, middle + 3, high, "whisker");
    }
    if (!series.paper.empty() && std::isfinite(series.paper[category]))
      drawing += paper_mark(middle, area.at_y(series.paper[category]));
  }
  return drawing;
}

}  // namespace

namespace svg {

PlotArea plot_area(const LineChart& chart) {
  std::vector<double> x, y;
  for (const LineSeries& series : chart.series) {
    x.insert(x.end(), series.x.begin(), series.x.end());
    for (const auto* values : {&series.y, &series.low, &series.high}) y.insert(y.end(), values->begin(), values->end());
  }
  for (const PaperMark& mark : chart.paper) {
    x.push_back(mark.x);
    y.push_back(mark.y);
  }
  return area_of(chart.width, chart.height, legend_of(chart), scale_for(x, chart.x, static_cast<int>(chart.width / 60)),
                 scale_for(y, chart.y, static_cast<int>(chart.height / 50)), !chart.y.label.empty());
}

PlotArea plot_area(const BarChart& chart) {
  std::vector<double> y;
  for (const BarSeries& series : chart.series)
    for (const auto* values : {&series.value, &series.low, &series.high, &series.paper})
      y.insert(y.end(), values->begin(), values->end());
  if (chart.arrangement == BarChart::Arrangement::stacked)
    for (std::size_t i = 0; i < chart.categories.size(); ++i) {
      double sum = 0;
      for (const BarSeries& series : chart.series) sum += std::isfinite(series.value[i]) ? series.value[i] : 0;
      y.push_back(sum);
    }
  Scale x;
  x.high = std::max<double>(1, static_cast<double>(chart.categories.size()));
  return area_of(chart.width, chart.height, legend_of(chart), x,
                 scale_for(y, chart.y, static_cast<int>(chart.height / 50)), !chart.y.label.empty());
}

}  // namespace svg

std::string svg_plot(const LineChart& chart) {
  validate(chart);
  const svg::PlotArea area = svg::plot_area(chart);
  std::string drawing = header(chart.title, area, legend_of(chart)) + area.axes(chart.x, chart.y);
  bool any = !chart.paper.empty();
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    any = any || !stretches(chart.series[k]).empty();
    drawing += curve(area, chart.series[k], k);
  }
  for (const PaperMark& mark : chart.paper)
    if (std::isfinite(mark.x) && std::isfinite(mark.y)) drawing += paper_mark(area.at_x(mark.x), area.at_y(mark.y));
  if (!any) drawing += area.no_data();
  return svg::picture(chart.width, chart.height, chart.title, drawing);
}

std::string svg_plot(const BarChart& chart) {
  validate(chart);
  const svg::PlotArea area = svg::plot_area(chart);
  std::string drawing = header(chart.title, area, legend_of(chart)) + area.y_axis(chart.y);
  drawing += svg::line(area.left, area.bottom(), area.right(), area.bottom(), "axis");
  double widest = 0;
  for (const std::string& category : chart.categories) widest = std::max(widest, svg::text_width(category) + 8);
  const double pitch = area.width / area.x.high, bar_share = 0.72;
  const auto every = static_cast<std::size_t>(std::ceil(widest / pitch));  // names that would run into each other
  for (std::size_t i = 0; i < chart.categories.size(); ++i) {
    const double left = area.at_x(static_cast<double>(i)) + pitch * (1 - bar_share) / 2, width = pitch * bar_share;
    drawing += chart.arrangement == BarChart::Arrangement::stacked ? stacked_bars(chart, area, i, left, width)
                                                                   : grouped_bars(chart, area, i, left, width);
    if (i % every == 0)
      drawing += svg::text(left + width / 2, area.bottom() + 17, chart.categories[i], svg::Anchor::middle, "tick");
  }
  if (!chart.category_label.empty())
    drawing += svg::text(area.left + area.width / 2, area.bottom() + 34, chart.category_label, svg::Anchor::middle);
  if (chart.categories.empty() || chart.series.empty()) drawing += area.no_data();
  return svg::picture(chart.width, chart.height, chart.title, drawing);
}

}  // namespace vantage
