#pragma once

#include <string>
#include <vector>

#include "vantage/report/svg.hpp"

namespace vantage {

/// One axis of a plot.
struct PlotAxis {
  enum class Start { data, zero };  // where the axis begins: at the least value, or at zero
  std::string label;                // with the unit, for example "distance [m]"
  Start start = Start::data;
  /// Only whole numbers get a tick (scans, views).
  enum class Ticks { any, whole };
  Ticks ticks = Ticks::any;
};

namespace svg {

/// A range of values and its round ticks.
struct Scale {
  double low = 0, high = 1;
  std::vector<double> ticks;
  int decimals = 0;  // of the ticks' numbers
};

/// The scale that holds all finite values; it ends on ticks. Values that are all equal, or none, get a scale too.
[[nodiscard]] Scale scale_for(const std::vector<double>& values, const PlotAxis& axis, int about_ticks);

/// The rectangle in which a plot draws, and the way from values to places in it.
struct PlotArea {
  double left = 0, top = 0, width = 1, height = 1;
  Scale x, y;

  [[nodiscard]] double at_x(double value) const { return left + width * (value - x.low) / (x.high - x.low); }
  [[nodiscard]] double at_y(double value) const { return top + height * (1 - (value - y.low) / (y.high - y.low)); }
  [[nodiscard]] double right() const { return left + width; }
  [[nodiscard]] double bottom() const { return top + height; }
  /// Grid lines, ticks, numbers and labels.
  [[nodiscard]] std::string axes(const PlotAxis& x_axis, const PlotAxis& y_axis) const;
  [[nodiscard]] std::string y_axis(const PlotAxis& axis) const;
  /// "no data" in the middle.
  [[nodiscard]] std::string no_data() const;
};

/// One row of names with their signs, from (x, y) to the right; each sign is drawn by SVG around its middle.
struct LegendEntry {
  std::string name;
  std::string sign;  // SVG drawn with its middle at (0, 0), 22 px wide
};
[[nodiscard]] std::string legend(double x, double y, double width, const std::vector<LegendEntry>& entries);
/// The rows that `legend` takes, at 17 px each.
[[nodiscard]] int legend_rows(double width, const std::vector<LegendEntry>& entries);
inline constexpr double legend_row_height = 17;

}  // namespace svg
}  // namespace vantage
