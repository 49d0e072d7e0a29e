#include "vantage/formats/float_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "vantage/core/error.hpp"
#include "vantage/core/text.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/half.hpp"

namespace vantage {
namespace {

constexpr std::string_view npy_magic = "\x93NUMPY";
constexpr int longest_float_side = 16384;

template <class Value>
Value value_at(std::string_view bytes, std::size_t index, bool is_little) {
  std::array<char, sizeof(Value)> raw{};
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(index * sizeof(Value)), sizeof(Value), raw.begin());
  if (is_little != (std::endian::native == std::endian::little)) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Value>(raw);
}

/// The text after `'key':` in the header of an array, which is a Python dictionary.
std::string_view header_value(std::string_view header, std::string_view key, const std::string& name) {
  const std::size_t at = header.find(fmt::format("'{}'", key));
  require(at != std::string_view::npos, name, ": the header has no '", std::string(key), "'");
  const std::size_t colon = header.find(':', at);
  require(colon != std::string_view::npos, name, ": the header ends after '", std::string(key), "'");
  return trimmed(header.substr(colon + 1));
}

Resolution shape_of(std::string_view text, const std::string& name) {
  const std::size_t end = text.find(')');
  require(!text.empty() && text[0] == '(' && end != std::string_view::npos, name, ": the shape is no tuple");
  std::vector<std::int64_t> sides;
  for (const std::string& part : split(text.substr(1, end - 1), ',')) {
    if (trimmed(part).empty()) continue;
    const auto side = to_integer(trimmed(part));
    require(side.has_value(), name, ": the shape has ", in_quotes(part), ": must be whole numbers");
    sides.push_back(*side);
  }
  if (sides.size() == 3 && sides.front() == 1) sides.erase(sides.begin());
  if (sides.size() == 3 && sides.back() == 1) sides.pop_back();
  require(sides.size() == 2, name, ": has ", sides.size(), " axes, must be rows and columns");
  for (const std::int64_t side : sides)
    require(side >= 1 && side <= longest_float_side, name, ": a side of ", side, ": must be within 1 and ",
            longest_float_side);
  return {static_cast<int>(sides[1]), static_cast<int>(sides[0])};
}

template <class Value>
Gray16 whole_numbers(std::string_view bytes, Resolution size, bool is_little, const std::string& name) {
  Gray16 image{size, std::vector<std::uint16_t>(static_cast<std::size_t>(size.rays()))};
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const auto value = value_at<Value>(bytes, i, is_little);
    require(std::in_range<std::uint16_t>(value), name, ": element ", i, " is ", static_cast<std::int64_t>(value),
            ": whole numbers must be within 0 and 65535");
    image.values[i] = static_cast<std::uint16_t>(value);
  }
  return image;
}

template <class Convert>
FloatImage floats(Resolution size, const Convert& convert) {
  FloatImage image{size, std::vector<float>(static_cast<std::size_t>(size.rays()))};
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = convert(i);
  return image;
}

DepthPixels pixels_of(std::string_view bytes, std::string_view type, Resolution size, bool is_little,
                      const std::string& name) {
  if (type == "u1") return whole_numbers<std::uint8_t>(bytes, size, is_little, name);
  if (type == "u2") return whole_numbers<std::uint16_t>(bytes, size, is_little, name);
  if (type == "i2") return whole_numbers<std::int16_t>(bytes, size, is_little, name);
  if (type == "u4") return whole_numbers<std::uint32_t>(bytes, size, is_little, name);
  if (type == "i4") return whole_numbers<std::int32_t>(bytes, size, is_little, name);
  if (type == "u8") return whole_numbers<std::uint64_t>(bytes, size, is_little, name);
  if (type == "i8") return whole_numbers<std::int64_t>(bytes, size, is_little, name);
  if (type == "f2")
    return floats(size, [&](std::size_t i) { return half_as_float(value_at<std::uint16_t>(bytes, i, is_little)); });
  if (type == "f4") return floats(size, [&](std::size_t i) { return value_at<float>(bytes, i, is_little); });
  return floats(size, [&](std::size_t i) { return static_cast<float>(value_at<double>(bytes, i, is_little)); });
}

}  // namespace

bool is_npy(std::string_view bytes) { return bytes.substr(0, npy_magic.size()) == npy_magic; }
bool is_pfm(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, 3);
  return start.size() == 3 && start[0] == 'P' && (start[1] == 'f' || start[1] == 'F') &&
         (start[2] == '\n' || start[2] == ' ' || start[2] == '\r');
}

DepthPixels decode_npy(std::string_view bytes, const std::string& name, std::int64_t most_pixels) {
  require(is_npy(bytes) && bytes.size() >= 10, name, ": is no NumPy array file");
  const bool is_long = bytes[6] > 1;  // the length of the header takes four bytes from version 2 on
  const std::size_t start = is_long ? 12 : 10;
  require(bytes.size() >= start, name, ": is cut off in its header");
  const std::size_t length =
      is_long ? value_at<std::uint32_t>(bytes.substr(8), 0, true) : value_at<std::uint16_t>(bytes.substr(8), 0, true);
  require(length <= bytes.size() - start, name, ": is cut off in its header");
  const std::string_view header = bytes.substr(start, length);
  const std::string_view descr = header_value(header, "descr", name);
  require(descr.size() >= 5 && (descr[0] == '\'' || descr[0] == '"'), name, ": has a type that is no number");
  const char order = descr[1];
  const std::string_view type = descr.substr(2, 2);
  constexpr std::array<std::string_view, 10> known{"u1", "u2", "i2", "u4", "i4", "u8", "i8", "f2", "f4", "f8"};
  require((order == '<' || order == '>' || order == '|' || order == '=') && descr[4] == descr[0] &&
              std::find(known.begin(), known.end(), type) != known.end(),
          name, ": has the type ", in_quotes(descr.substr(0, 5)),
          ": must be uint16 or another whole number, or a float");
  require(header_value(header, "fortran_order", name).substr(0, 5) == "False", name,
          ": is stored column by column; write it with numpy.ascontiguousarray");
  const Resolution size = shape_of(header_value(header, "shape", name), name);
  require_pixels(size, most_pixels, name);
  const std::string_view values = bytes.substr(start + length);
  const std::size_t expected = static_cast<std::size_t>(size.rays()) * static_cast<std::size_t>(type[1] - '0');
  require(values.size() == expected, name, ": has ", values.size(), " bytes of values, must be ", expected);
  return pixels_of(values, type, size, order != '>', name);
}

FloatImage decode_pfm(std::string_view bytes, const std::string& name, std::int64_t most_pixels) {
  require(is_pfm(bytes), name, ": is no portable float map");
  require(bytes[1] == 'f', name, ": has colours (PF), must be grey (Pf)");
  // Three more words, then one blank, then the values.
  std::size_t at = 2;
  const auto next_word = [&] {
    while (at < bytes.size() && std::isspace(static_cast<unsigned char>(bytes[at])) != 0) ++at;
    const std::size_t first = at;
    while (at < bytes.size() && std::isspace(static_cast<unsigned char>(bytes[at])) == 0) ++at;
    return bytes.substr(first, at - first);
  };
  const auto columns = to_integer(next_word()), rows = to_integer(next_word());
  const auto scale = to_double(next_word());
  require(
      columns && rows && *columns >= 1 && *rows >= 1 && *columns <= longest_float_side && *rows <= longest_float_side,
      name, ": must have a width and a height within 1 and ", longest_float_side);
  require(scale && std::isfinite(*scale) && *scale != 0, name, ": has no scale");
  const Resolution size{static_cast<int>(*columns), static_cast<int>(*rows)};
  require_pixels(size, most_pixels, name);
  const std::string_view values = bytes.substr(std::min(at + 1, bytes.size()));
  const std::size_t expected = 4 * static_cast<std::size_t>(size.rays());
  require(values.size() >= expected, name, ": has ", values.size(), " bytes of values, must be ", expected);
  return floats(size, [&](std::size_t i) {
    const auto row = i / static_cast<std::size_t>(size.columns), column = i % static_cast<std::size_t>(size.columns);
    const std::size_t from_below =
        (static_cast<std::size_t>(size.rows) - 1 - row) * static_cast<std::size_t>(size.columns) + column;
    return value_at<float>(values, from_below, *scale < 0);
  });
}

}  // namespace vantage
