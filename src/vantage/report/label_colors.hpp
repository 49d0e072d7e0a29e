#pragma once

#include "vantage/map/label.hpp"
#include "vantage/report/color.hpp"

namespace vantage {

/// The one colour of a label in every picture and plot. Told apart by lightness as well as by hue.
[[nodiscard]] constexpr Color label_color(Label label) {
  switch (label) {
    case Label::unmarked:
      return color(0x9AA0A6);
    case Label::occupied:
      return palette::orange;
    case Label::empty:
      return color(0xE3F1FA);  // a tint of sky: most of every slice is empty
    case Label::occluded:
      return palette::purple;
    case Label::occplane:
      break;
  }
  return palette::blue;
}

}  // namespace vantage
