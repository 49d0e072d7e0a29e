#pragma once

#include "vantage/io/color.hpp"
#include "vantage/map/label.hpp"

namespace vantage {

/// The one colour of a label in every picture and plot. Told apart by lightness as well as by hue.
[[nodiscard]] constexpr Color label_color(Label label) {
  switch (label) {
    case Label::occupied:
      return palette::blue;
    case Label::occplane:
      return palette::orange;
    case Label::occluded:
      return palette::purple;
    case Label::unmarked:
      return color(0x8C8C8C);
    case Label::empty:
      break;
  }
  return color(0xF4F6F8);
}

}  // namespace vantage
