#include "vantage/report/plot_area.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vantage::svg {
namespace {

constexpr double sign_width = 26, entry_gap = 16;

double entry_width(const LegendEntry& entry) { return sign_width + text_width(entry.name) + entry_gap; }

/// 1, 2 or 5 times a power of ten, the least that is not below `wanted`.
double round_step(double wanted) {
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= wanted * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

}  // namespace

Scale scale_for(const std::vector<double>& values, const PlotAxis& axis, int about_ticks) {
  double low = axis.start == PlotAxis::Start::zero ? 0 : INFINITY, high = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!std::isfinite(low)) low = std::isfinite(high) ? high : 0;
  if (!std::isfinite(high)) high = low + 1;
  if (high - low < 1e-9 * std::max(std::abs(low), std::abs(high)) || high == low) {
    const double room = high == 0 ? 1 : std::abs(high) * 0.1;
    high += room;
    if (axis.start != PlotAxis::Start::zero) low -= room;
  }
  double step = round_step((high - low) / std::max(1, about_ticks));
  if (axis.ticks == PlotAxis::Ticks::whole) step = std::max(1.0, step);
  Scale scale;
  const double first = std::floor(low / step + 1e-9), last = std::ceil(high / step - 1e-9);
  scale.low = axis.ticks == PlotAxis::Ticks::whole ? low : first * step;
  scale.high = axis.ticks == PlotAxis::Ticks::whole ? high : last * step;
  for (double k = first; k <= last; ++k) {
    const double tick = k * step;
    if (tick >= scale.low - 1e-9 * step && tick <= scale.high + 1e-9 * step) scale.ticks.push_back(tick);
  }
  scale.decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  return scale;
}

std::string PlotArea::y_axis(const PlotAxis& axis) const {
  std::string drawing;
  double widest = 0;
  for (const double tick : y.ticks) {
    const std::string name = readable(tick, y.decimals);
    widest = std::max(widest, text_width(name));
    drawing += line(left, at_y(tick), right(), at_y(tick), "grid");
    drawing += text(left - 7, at_y(tick) + 4, name, Anchor::end, "tick");
  }
  if (!axis.label.empty())
    drawing += fmt::format("<text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                           number(left - 16 - widest), number(top + height / 2), escape_markup(axis.label));
  return drawing;
}

std::string PlotArea::axes(const PlotAxis& x_axis_options, const PlotAxis& y_axis_options) const {
  std::string drawing = y_axis(y_axis_options);
  for (const double tick : x.ticks) {
    drawing += line(at_x(tick), bottom(), at_x(tick), bottom() + 4, "axis");
    drawing += text(at_x(tick), bottom() + 17, readable(tick, x.decimals), Anchor::middle, "tick");
  }
  drawing += line(left, bottom(), right(), bottom(), "axis");
  if (!x_axis_options.label.empty())
    drawing += text(left + width / 2, bottom() + 34, x_axis_options.label, Anchor::middle);
  return drawing;
}

std::string PlotArea::no_data() const {
  return text(left + width / 2, top + height / 2, "no data", Anchor::middle, "none");
}

std::string legend(double x, double y, double width, const std::vector<LegendEntry>& entries) {
  std::string drawing;
  double place = 0, row = 0;
  for (const LegendEntry& entry : entries) {
    if (place > 0 && place + entry_width(entry) - entry_gap > width) {
      place = 0;
      ++row;
    }
    const double row_y = y + row * legend_row_height;
    drawing += fmt::format("<g transform=\"translate({} {})\">{}</g>\n", number(x + place + 11), number(row_y - 4),
                           entry.sign);
    drawing += text(x + place + sign_width, row_y, entry.name, Anchor::start);
    place += entry_width(entry);
  }
  return drawing;
}

int legend_rows(double width, const std::vector<LegendEntry>& entries) {
  int rows = entries.empty() ? 0 : 1;
  double place = 0;
  for (const LegendEntry& entry : entries) {
    if (place > 0 && place + entry_width(entry) - entry_gap > width) {
      place = 0;
      ++rows;
    }
    place += entry_width(entry);
  }
  return rows;
}

}  // namespace vantage::svg
