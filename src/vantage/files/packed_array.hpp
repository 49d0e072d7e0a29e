#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace vantage {

/// How a packed array of docs/report-data.md stores its rows.
enum class PackedRows {
  plain,
  differences  // to the row before, as byte planes: whole numbers only, smaller for smooth data
};

/// The base64 text (RFC 4648, with padding) of some bytes.
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);
/// The bytes as a zlib stream (RFC 1950).
[[nodiscard]] std::string zlib_compressed(std::span<const std::uint8_t> bytes);

/// A packed array of docs/report-data.md: `values` row by row, `columns` in each row. Defined for the numbers of
/// 8 to 32 bits that the format knows. Throws InputError where the values do not fill whole rows.
template <class Number>
[[nodiscard]] nlohmann::ordered_json packed_array(std::span<const Number> values, int columns = 1,
                                                  PackedRows rows = PackedRows::plain);

}  // namespace vantage
