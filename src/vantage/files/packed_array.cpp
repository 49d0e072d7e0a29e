#include "vantage/files/packed_array.hpp"

#include <zlib.h>

#include <bit>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

static_assert(std::endian::native == std::endian::little, "packed arrays are written as they lie in memory");

template <class Number>
constexpr const char* type_name() {
  if constexpr (std::is_same_v<Number, std::uint8_t>) return "u8";
  if constexpr (std::is_same_v<Number, std::int8_t>) return "i8";
  if constexpr (std::is_same_v<Number, std::uint16_t>) return "u16";
  if constexpr (std::is_same_v<Number, std::int16_t>) return "i16";
  if constexpr (std::is_same_v<Number, std::uint32_t>) return "u32";
  if constexpr (std::is_same_v<Number, std::int32_t>) return "i32";
  if constexpr (std::is_same_v<Number, float>) return "f32";
}

/// For each column, for each byte from the lowest: that byte of the difference to the row before, for all rows.
template <class Number>
std::vector<std::uint8_t> difference_planes(std::span<const Number> values, std::size_t columns) {
  using Bits = std::make_unsigned_t<Number>;
  const std::size_t rows = values.size() / columns;
  std::vector<std::uint8_t> planes(values.size_bytes());
  for (std::size_t column = 0; column < columns; ++column) {
    Bits last = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      const auto value = static_cast<Bits>(values[row * columns + column]);
      const auto difference = static_cast<Bits>(value - last);
      last = value;
      for (std::size_t byte = 0; byte < sizeof(Number); ++byte) {
        planes[(column * sizeof(Number) + byte) * rows + row] = static_cast<std::uint8_t>(difference >> (8 * byte));
      }
    }
  }
  return planes;
}

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < left ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= left ? digits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string zlib_compressed(std::span<const std::uint8_t> bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string stream(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(stream.data()), &size, bytes.data(),
                               static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION);
  if (status != Z_OK) throw Error(concat("zlib could not compress ", bytes.size(), " bytes: status ", status));
  stream.resize(size);
  return stream;
}

template <class Number>
nlohmann::ordered_json packed_array(std::span<const Number> values, int columns, PackedRows rows) {
  require(columns > 0 && values.size() % static_cast<std::size_t>(columns) == 0, "packed array: ", values.size(),
          " values do not fill rows of ", columns);
  std::vector<std::uint8_t> planes;
  std::span<const std::uint8_t> bytes{reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
  if (rows == PackedRows::differences) {
    if constexpr (std::is_integral_v<Number>) {
      planes = difference_planes(values, static_cast<std::size_t>(columns));
      bytes = planes;
    } else {
      throw InputError("packed array: differences are for whole numbers only");
    }
  }
  const std::string stream = zlib_compressed(bytes);
  auto shape = nlohmann::ordered_json::array({values.size() / static_cast<std::size_t>(columns)});
  if (columns > 1) shape.push_back(columns);
  return {{"type", type_name<Number>()},
          {"shape", std::move(shape)},
          {"delta", rows == PackedRows::differences},
          {"data", base64({reinterpret_cast<const std::uint8_t*>(stream.data()), stream.size()})}};
}

template nlohmann::ordered_json packed_array(std::span<const std::uint8_t>, int, PackedRows);
template nlohmann::ordered_json packed_array(std::span<const std::int8_t>, int, PackedRows);
template nlohmann::ordered_json packed_array(std::span<const std::uint16_t>, int, PackedRows);
template nlohmann::ordered_json packed_array(std::span<const std::int16_t>, int, PackedRows);
template nlohmann::ordered_json packed_array(std::span<const std::uint32_t>, int, PackedRows);
template nlohmann::ordered_json packed_array(std::span<const std::int32_t>, int, PackedRows);
template nlohmann::ordered_json packed_array(std::span<const float>, int, PackedRows);

}  // namespace vantage
