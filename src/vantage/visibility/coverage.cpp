#include "vantage/visibility/coverage.hpp"

#include <algorithm>

namespace vantage {

void Coverage::reset(Resolution resolution) {
  constexpr std::uint64_t all = ~std::uint64_t{0};
  const int columns = (resolution.columns + 7) / 8;
  const int rows = (resolution.rows + 7) / 8;
  stride_ = columns + 2 * border;
  tiles_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows + 2 * border), all);
  const int spare_columns = 8 * columns - resolution.columns;
  const int spare_rows = 8 * rows - resolution.rows;
  const std::uint64_t right_of_frame = 0x0101010101010101U * ((0xff00U >> spare_columns) & 0xffU);
  const std::uint64_t below_frame = spare_rows == 0 ? 0 : all << (8 * (8 - spare_rows));
  for (int row = 0; row < rows; ++row) {
    std::uint64_t* tiles = first_tile() + static_cast<std::ptrdiff_t>(row) * stride_;
    std::fill_n(tiles, columns, row == rows - 1 ? below_frame : 0);
    tiles[columns - 1] |= right_of_frame;
  }
}

}  // namespace vantage
