#pragma once

#include "vantage/report/color.hpp"
#include "vantage/report/picture.hpp"

namespace vantage {

/// Draws a filled circle with a number in it over the picture; `x`, `y` is its middle and `radius` its size in pixels.
/// What lies outside the picture is cut off.
void draw_badge(Picture& picture, double x, double y, double radius, int number, const Color& color);

}  // namespace vantage
