#include "vantage/visibility/coverage.hpp"

#include <algorithm>

namespace vantage {

void Coverage::reset(Resolution resolution) {
  constexpr int word = 8;  // bytes, so that words can be read from the last row on
  const int strips = (resolution.columns + 7) / 8;
  stride_ = resolution.rows + 2 * border_rows + word;
  strips_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(strips + 2 * border_strips), 0xff);
  const int spare_columns = 8 * strips - resolution.columns;
  const auto right_of_frame = static_cast<std::uint8_t>(0xff00U >> spare_columns);
  for (int strip = 0; strip < strips; ++strip) {
    std::uint8_t* const first = first_strip() + static_cast<std::ptrdiff_t>(strip) * stride_;
    std::fill_n(first, resolution.rows, strip == strips - 1 ? right_of_frame : std::uint8_t{0});
  }
}

}  // namespace vantage
