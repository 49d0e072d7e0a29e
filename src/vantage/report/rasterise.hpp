#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage::raster {

/// A corner on the screen (pixels, x right, y down) with a nearness that is linear on the screen: larger is nearer.
struct Corner {
  float x = 0, y = 0, nearness = 0;
};
using Triangle = std::array<Corner, 3>;

/// A window of columns and rows, the ends exclusive.
struct Window {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// The samples (middles of pixels) of the window within [low, high] on one axis: the first, and the one past the last.
/// A bound far off the screen does not fit in an int, so it is compared before it is converted.
[[nodiscard]] inline int first_sample(float low, int window_first) {
  return low <= static_cast<float>(window_first) ? window_first : static_cast<int>(std::ceil(low - 0.5F));
}
[[nodiscard]] inline int end_sample(float high, int window_end) {
  return high >= static_cast<float>(window_end) ? window_end : static_cast<int>(std::floor(high - 0.5F)) + 1;
}
[[nodiscard]] inline bool meets(float left, float top, float right, float bottom, const Window& window) {
  return right >= static_cast<float>(window.left) && left <= static_cast<float>(window.right) &&
         bottom >= static_cast<float>(window.top) && top <= static_cast<float>(window.bottom);
}

/// Calls `body(column, row)` for every sample of the window at most `reach` from the middle on both axes.
template <class Body>
void for_each_in_square(const Corner& middle, float reach, const Window& window, const Body& body) {
  if (!meets(middle.x - reach, middle.y - reach, middle.x + reach, middle.y + reach, window)) return;
  const int left = first_sample(middle.x - reach, window.left), right = end_sample(middle.x + reach, window.right);
  const int top = first_sample(middle.y - reach, window.top), bottom = end_sample(middle.y + reach, window.bottom);
  for (int row = top; row < bottom; ++row)
    for (int column = left; column < right; ++column) body(column, row);
}

/// Calls `put(column, row, nearness)` for every sample of the window inside the triangle, borders included.
template <class Put>
void fill(const Triangle& triangle, const Window& window, const Put& put) {
  const auto [low_x, high_x] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
  const auto [low_y, high_y] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
  if (!meets(low_x, low_y, high_x, high_y, window)) return;
  const int left = first_sample(low_x, window.left), right = end_sample(high_x, window.right);
  const int top = first_sample(low_y, window.top), bottom = end_sample(high_y, window.bottom);
  const auto side = [](const Corner& a, const Corner& b, double x, double y) {
    return (static_cast<double>(b.x) - a.x) * (y - a.y) - (static_cast<double>(b.y) - a.y) * (x - a.x);
  };
  if (left >= right || top >= bottom) return;
  const double area = side(triangle[0], triangle[1], triangle[2].x, triangle[2].y);
  if (area == 0) return;
  const double step0 = -(static_cast<double>(triangle[2].y) - triangle[1].y) / area;
  const double step1 = -(static_cast<double>(triangle[0].y) - triangle[2].y) / area;
  for (int row = top; row < bottom; ++row) {
    const double y = row + 0.5, x = left + 0.5;
    double share0 = side(triangle[1], triangle[2], x, y) / area, share1 = side(triangle[2], triangle[0], x, y) / area;
    for (int column = left; column < right; ++column, share0 += step0, share1 += step1) {
      const double share2 = 1 - share0 - share1;
      if (share0 < 0 || share1 < 0 || share2 < 0) continue;
      put(column, row,
          static_cast<float>(share0 * triangle[0].nearness + share1 * triangle[1].nearness +
                             share2 * triangle[2].nearness));
    }
  }
}

}  // namespace vantage::raster
