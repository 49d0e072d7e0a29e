#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vantage/report/color.hpp"

namespace vantage {

/// Text for XML and HTML, in elements and in quoted attributes. Control characters, which no XML may hold, become '?'.
[[nodiscard]] std::string escape_markup(std::string_view text);

/// A number for people: at most `decimals` decimals, thousands apart by thin spaces, a true minus sign; an en dash for
/// NaN and infinities.
[[nodiscard]] std::string readable(double value, int decimals = 0);

namespace svg {

/// A coordinate with at most two decimals, without trailing zeros. The value must be finite.
[[nodiscard]] std::string number(double value);

enum class Anchor { start, middle, end };

/// <text>. `css_class` may be empty.
[[nodiscard]] std::string text(double x, double y, std::string_view content, Anchor anchor,
                               std::string_view css_class = "");
[[nodiscard]] std::string line(double x1, double y1, double x2, double y2, std::string_view css_class);
/// A small mark that tells series `k` apart from others by its shape: circle, square, triangle, diamond, cross.
[[nodiscard]] std::string mark(double x, double y, std::size_t k);
/// The width of a text in the plots' letters of 12 px, roughly.
[[nodiscard]] double text_width(std::string_view content);

inline constexpr double title_height = 24;  // px, above a drawing

/// The element <svg class="plot"> around a drawing, with a title that screen readers say.
[[nodiscard]] std::string picture(double width, double height, std::string_view title, std::string_view content);

}  // namespace svg

/// The style of all plots: colours as variables for light, dark and paper. Goes once into a page.
[[nodiscard]] std::string plot_style();

/// A plot as a file of its own, with its style.
[[nodiscard]] std::string standalone_svg(std::string_view plot);

/// How many kinds of series the style tells apart; further ones repeat.
inline constexpr std::size_t series_styles = 7;

}  // namespace vantage
