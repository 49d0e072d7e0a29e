#pragma once

#include <string>
#include <vector>

#include "vantage/report/plot_area.hpp"

namespace vantage {

/// Values over x. NaN leaves a gap.
struct LineSeries {
  std::string name;
  std::vector<double> x, y;
  /// A band around the curve (an interval of the mean); empty for none, otherwise as long as y.
  std::vector<double> low, high;
};

/// A published value drawn into a plot as an open diamond.
struct PaperMark {
  double x = 0, y = 0;
};

struct LineChart {
  std::string title;
  PlotAxis x, y;
  std::vector<LineSeries> series;
  std::vector<PaperMark> paper;
  double width = 480, height = 300;
};

struct BarSeries {
  std::string name;
  std::vector<double> value;      // one per category; NaN: no bar
  std::vector<double> low, high;  // ends of a whisker per bar; empty for none
  std::vector<double> paper;      // published value per bar; empty for none, NaN where there is none
};

struct BarChart {
  enum class Arrangement { grouped, stacked };
  std::string title;
  std::string category_label;
  std::vector<std::string> categories;
  PlotAxis y{.label = "", .start = PlotAxis::Start::zero};
  std::vector<BarSeries> series;
  Arrangement arrangement = Arrangement::grouped;
  double width = 480, height = 300;
};

/// The plot as an <svg> element; its look comes from plot_style(). Throws InputError where lengths do not agree.
[[nodiscard]] std::string svg_plot(const LineChart& chart);
[[nodiscard]] std::string svg_plot(const BarChart& chart);

namespace svg {
/// Where the plots draw, for tests and for drawing on top.
[[nodiscard]] PlotArea plot_area(const LineChart& chart);
[[nodiscard]] PlotArea plot_area(const BarChart& chart);
}  // namespace svg

}  // namespace vantage
