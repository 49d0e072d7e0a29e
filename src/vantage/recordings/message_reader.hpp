#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "vantage/core/error.hpp"

namespace vantage {

/// How the fields of a message are laid out: as ROS 1 does it (little endian, packed), or in OMG's Common Data
/// Representation, which ROS 2 uses (either byte order, numbers aligned to their size, four bytes ahead that say
/// which).
enum class Serialization { ros1, cdr };

/// The fields of one message, in their order. Throws InputError starting with `name` where the message ends too early
/// or promises more than it holds.
class MessageReader {
 public:
  /// The bytes must outlive the reader.
  MessageReader(std::string_view bytes, Serialization serialization, std::string name);

  [[nodiscard]] Serialization serialization() const { return serialization_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  [[nodiscard]] std::uint8_t u8() { return static_cast<std::uint8_t>(take(1)[0]); }
  [[nodiscard]] std::uint32_t u32() { return static_cast<std::uint32_t>(number<4>()); }
  [[nodiscard]] std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
  [[nodiscard]] float f32() { return std::bit_cast<float>(u32()); }
  [[nodiscard]] double f64() { return std::bit_cast<double>(number<8>()); }
  [[nodiscard]] std::string text();
  /// The elements of a list of bytes.
  [[nodiscard]] std::string_view byte_list() { return take(u32()); }
  /// The number of elements of a list whose elements take at least `least_bytes` each.
  [[nodiscard]] std::uint32_t list_size(std::uint32_t least_bytes);

  /// Throws InputError with this message.
  [[noreturn]] void fail(std::string_view message) const;

 private:
  [[nodiscard]] std::string_view take(std::uint64_t count);
  template <int Bytes>
  [[nodiscard]] std::uint64_t number();
  void align(std::size_t size);

  std::string_view bytes_;  // without CDR's first four
  Serialization serialization_;
  std::string name_;
  std::size_t position_ = 0;
  std::size_t largest_alignment_ = 8;
  bool is_big_endian_ = false;
};

}  // namespace vantage
