#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "vantage/files/text_reader.hpp"
#include "vantage/formats/camera_file.hpp"
#include "vantage/formats/camera_parts.hpp"
#include "vantage/formats/colmap_file.hpp"

namespace vantage {
namespace {

using camera_parts::checked;
using camera_parts::from_rows;

constexpr const char* matrix_text = "3 rows of 3 numbers (fx 0 cx, 0 fy cy, 0 0 1)";

/// The numbers of the line; throws InputError for a word that is none.
std::vector<double> numbers_of_line(TextReader& text, std::size_t row) {
  std::vector<double> numbers;
  while (!text.at_end_of_line()) {
    if (numbers.size() == 16) text.fail("more than 16 numbers in a line");
    numbers.push_back(text.finite_number(fmt::format("number {} of row {}", numbers.size() + 1, row)));
  }
  return numbers;
}

/// KITTI's `P0: ` or `P_rect_02: ` and 12 numbers.
std::optional<Intrinsics> kitti_camera(TextReader text) {
  while (text.next_line_with_words()) {
    const std::string_view word = text.word();
    if (word.empty() || word[0] != 'P' || word.back() != ':') continue;
    const std::vector<double> numbers = numbers_of_line(text, 1);
    if (numbers.size() != 12) continue;
    return Intrinsics{.fx = numbers[0],
                      .fy = numbers[5],
                      .cx = numbers[2],
                      .cy = numbers[6],
                      .resolution = std::nullopt,
                      .distortion = {}};
  }
  return std::nullopt;
}

bool starts_with_number(std::string_view line) {
  TextReader text(line, "");
  return text.next_line() && to_double(text.word()).has_value();
}

Intrinsics matrix_in(TextReader text, const std::string& name) {
  std::vector<double> all;
  std::size_t rows = 0, columns = 0;
  while (text.next_line_with_words()) {
    if (trimmed(text.rest_of_line())[0] == '#') continue;
    const std::vector<double> numbers = numbers_of_line(text, ++rows);
    if (rows == 1) columns = numbers.size();
    if (rows > 4) text.fail(fmt::format("a fifth row, must be {}", matrix_text));
    if (numbers.size() < columns) text.fail(fmt::format("number {} of row {} is missing", numbers.size() + 1, rows));
    if (numbers.size() > columns)
      text.fail(fmt::format("row {} has {} numbers, must be {}", rows, numbers.size(), matrix_text));
    all.insert(all.end(), numbers.begin(), numbers.end());
  }
  if (rows == 1 && columns == 4)
    return {.fx = all[0], .fy = all[1], .cx = all[2], .cy = all[3], .resolution = std::nullopt, .distortion = {}};
  const bool is_matrix =
      (rows == 1 && (columns == 9 || columns == 16)) || (rows == columns && (rows == 3 || rows == 4));
  require(is_matrix, name, ": has ", rows, " rows of ", columns, " numbers, must be ", matrix_text,
          "; also 4x4, one row of 9 or 16, or fx fy cx cy");
  return from_rows(all, name);
}

}  // namespace

Intrinsics parse_intrinsics_text(std::string_view bytes, const std::string& name) {
  if (is_colmap_cameras(bytes)) {
    const std::vector<ColmapCamera> cameras = parse_colmap_cameras(bytes, name);
    require(cameras.size() == 1, name, ": has ", cameras.size(), " cameras; must be one to be the depth images'");
    return cameras.front().intrinsics;
  }
  TextReader text(bytes, name);
  TextReader first = text;
  if (first.next_line_with_words() && std::isalpha(static_cast<unsigned char>(trimmed(first.rest_of_line())[0])) != 0 &&
      !starts_with_number(first.rest_of_line())) {
    if (const auto camera = kitti_camera(text)) return checked(*camera, name);
  }
  return checked(matrix_in(text, name), name);
}

}  // namespace vantage
