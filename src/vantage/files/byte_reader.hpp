#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "vantage/core/error.hpp"

namespace vantage {

/// Unsigned number of `Bytes` bytes at `at`, which must exist.
template <int Bytes>
[[nodiscard]] inline std::uint64_t little_endian(const char* at) {
  std::uint64_t value = 0;
  for (int k = 0; k < Bytes; ++k) value |= std::uint64_t{static_cast<unsigned char>(at[k])} << (8 * k);
  return value;
}

/// Walks over binary data, little endian. Throws InputError starting with `name`, and naming the place, where the data
/// ends too early.
class ByteReader {
 public:
  /// The bytes must outlive the reader. `place` is where they begin in their file.
  ByteReader(std::string_view bytes, std::string name, std::uint64_t place = 0)
      : bytes_(bytes), name_(std::move(name)), place_(place) {}

  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }
  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  std::string_view bytes(std::uint64_t count, const char* what) {
    if (count > left()) {
      throw InputError(
          concat(name_, ", byte ", place_ + position_, ": ", what, " needs ", count, " bytes, there are ", left()));
    }
    const std::string_view taken = bytes_.substr(position_, count);
    position_ += count;
    return taken;
  }
  std::uint8_t u8(const char* what) { return static_cast<std::uint8_t>(bytes(1, what)[0]); }
  std::uint16_t u16(const char* what) { return static_cast<std::uint16_t>(little_endian<2>(bytes(2, what).data())); }
  std::uint32_t u32(const char* what) { return static_cast<std::uint32_t>(little_endian<4>(bytes(4, what).data())); }
  std::uint64_t u64(const char* what) { return little_endian<8>(bytes(8, what).data()); }
  /// Bytes after their number in 32 bits.
  std::string_view counted(const char* what) { return bytes(u32(what), what); }

 private:
  std::string_view bytes_;
  std::string name_;
  std::uint64_t place_;
  std::size_t position_ = 0;
};

}  // namespace vantage
