#include "vantage/report/badge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace vantage {
namespace {

struct Point {
  double x = 0, y = 0;
};
using Polyline = std::vector<Point>;

/// Points on an ellipse; degrees clockwise from 3 o'clock, as y points down.
void add_ellipse(Polyline& line, Point middle, Point radii, double from, double to) {
  constexpr int steps = 16;
  for (int i = 0; i <= steps; ++i) {
    const double angle = (from + (to - from) * i / steps) * 3.14159265358979323846 / 180;
    line.push_back({middle.x + radii.x * std::cos(angle), middle.y + radii.y * std::sin(angle)});
  }
}

/// The strokes of a digit (or '-') in a cell 0.6 wide and 1 high, y down.
std::vector<Polyline> digit_strokes(char digit) {
  Polyline a, b;
  switch (digit) {
    case '0':
      add_ellipse(a, {0.3, 0.5}, {0.28, 0.5}, 0, 360);
      break;
    case '1':
      a = {{0.1, 0.2}, {0.34, 0}, {0.34, 1}};
      break;
    case '2':
      add_ellipse(a, {0.3, 0.29}, {0.27, 0.29}, 190, 390);
      a.insert(a.end(), {{0.03, 1}, {0.6, 1}});
      break;
    case '3':
      add_ellipse(a, {0.28, 0.25}, {0.25, 0.25}, 200, 450);
      add_ellipse(b, {0.28, 0.74}, {0.29, 0.26}, 270, 520);
      break;
    case '4':
      a = {{0.62, 0.72}, {0, 0.72}, {0.44, 0}, {0.44, 1}};
      break;
    case '5':
      a = {{0.54, 0}, {0.1, 0}, {0.06, 0.45}};
      add_ellipse(a, {0.29, 0.68}, {0.29, 0.32}, 235, 510);
      break;
    case '6':
      add_ellipse(a, {0.3, 0.68}, {0.28, 0.32}, -180, 180);
      b = {{0.02, 0.68}, {0.06, 0.4}, {0.2, 0.14}, {0.44, 0}};
      break;
    case '7':
      a = {{0.02, 0}, {0.58, 0}, {0.2, 1}};
      break;
    case '8':
      add_ellipse(a, {0.3, 0.25}, {0.24, 0.25}, 0, 360);
      add_ellipse(b, {0.3, 0.75}, {0.29, 0.25}, 0, 360);
      break;
    case '9':
      add_ellipse(a, {0.3, 0.32}, {0.28, 0.32}, 0, 360);
      b = {{0.58, 0.32}, {0.54, 0.6}, {0.4, 0.86}, {0.16, 1}};
      break;
    default:
      a = {{0.08, 0.5}, {0.52, 0.5}};
  }
  return b.empty() ? std::vector<Polyline>{a} : std::vector<Polyline>{a, b};
}

double distance_to_segment(Point p, Point a, Point b) {
  const double ux = b.x - a.x, uy = b.y - a.y, squared = ux * ux + uy * uy;
  const double share = squared > 0 ? std::clamp(((p.x - a.x) * ux + (p.y - a.y) * uy) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - share * ux, p.y - a.y - share * uy);
}

/// The strokes of all digits, in pixels around the middle.
std::vector<Polyline> number_strokes(int number, double digit_height) {
  constexpr double pitch = 0.86;  // from one digit to the next, in digit heights
  const std::string text = std::to_string(number);
  const double width = pitch * static_cast<double>(text.size() - 1) + 0.6;
  std::vector<Polyline> strokes;
  for (std::size_t i = 0; i < text.size(); ++i)
    for (Polyline stroke : digit_strokes(text[i])) {
      for (Point& point : stroke)
        point = {digit_height * (point.x + pitch * static_cast<double>(i) - width / 2), digit_height * (point.y - 0.5)};
      strokes.push_back(std::move(stroke));
    }
  return strokes;
}

void blend(Picture& picture, int x, int y, const Color& color, double share) {
  const std::size_t k =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x));
  const std::array<double, 3> channel{color.red, color.green, color.blue};
  for (std::size_t c = 0; c < 3; ++c) {
    const double before = picture.rgb[k + c];
    picture.rgb[k + c] = static_cast<std::uint8_t>(std::lround(before + (channel[c] * 255 - before) * share));
  }
}

}  // namespace

void draw_badge(Picture& picture, double x, double y, double radius, int number, const Color& color) {
  const bool dark = 0.3 * color.red + 0.59 * color.green + 0.11 * color.blue < 0.6;
  const Color ink = dark ? Color{1, 1, 1} : palette::black;
  const double digit_height = radius * (number >= 100 ? 0.62 : number >= 10 ? 0.84 : 1.04);
  const double half_width = std::max(0.6, digit_height * 0.085);
  const std::vector<Polyline> strokes = number_strokes(number, digit_height);
  constexpr double rim = 1.5;  // pixels of white around the circle
  const int left = std::max(0, static_cast<int>(std::floor(x - radius - rim - 1)));
  const int right = std::min(picture.width - 1, static_cast<int>(std::ceil(x + radius + rim + 1)));
  const int top = std::max(0, static_cast<int>(std::floor(y - radius - rim - 1)));
  const int bottom = std::min(picture.height - 1, static_cast<int>(std::ceil(y + radius + rim + 1)));
  for (int row = top; row <= bottom; ++row)
    for (int column = left; column <= right; ++column) {
      const Point pixel{column + 0.5 - x, row + 0.5 - y};
      const double from_middle = std::hypot(pixel.x, pixel.y);
      blend(picture, column, row, {1, 1, 1}, std::clamp(radius + rim + 0.5 - from_middle, 0.0, 1.0));
      blend(picture, column, row, color, std::clamp(radius + 0.5 - from_middle, 0.0, 1.0));
      double nearest = 1e9;
      for (const Polyline& stroke : strokes)
        for (std::size_t i = 1; i < stroke.size(); ++i)
          nearest = std::min(nearest, distance_to_segment(pixel, stroke[i - 1], stroke[i]));
      blend(picture, column, row, ink, std::clamp(half_width + 0.5 - nearest, 0.0, 1.0));
    }
}

}  // namespace vantage
