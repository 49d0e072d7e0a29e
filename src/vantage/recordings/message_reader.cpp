#include "vantage/recordings/message_reader.hpp"

#include <algorithm>

namespace vantage {

MessageReader::MessageReader(std::string_view bytes, Serialization serialization, std::string name)
    : bytes_(bytes), serialization_(serialization), name_(std::move(name)) {
  if (serialization_ == Serialization::ros1) return;
  const std::string_view head = take(4);
  const auto kind = static_cast<unsigned char>(head[1]);
  // Plain CDR of version 1 and of version 2, which aligns to at most four bytes; odd numbers are little endian.
  const bool is_plain = head[0] == 0 && (kind <= 1 || kind == 6 || kind == 7);
  if (!is_plain) fail(concat("its CDR is of kind ", int{kind}, "; must be plain CDR (0, 1, 6 or 7)"));
  is_big_endian_ = kind % 2 == 0;
  largest_alignment_ = kind <= 1 ? 8 : 4;
  bytes_.remove_prefix(4);
  position_ = 0;
}

void MessageReader::fail(std::string_view message) const { throw InputError(concat(name_, ": ", message)); }

std::string_view MessageReader::take(std::uint64_t count) {
  if (count > left())
    fail(concat("the message ends at byte ", position_, "; ", count, " more are promised, ", left(), " are there"));
  const std::string_view taken = bytes_.substr(position_, count);
  position_ += count;
  return taken;
}

void MessageReader::align(std::size_t size) {
  if (serialization_ == Serialization::ros1) return;
  const std::size_t step = std::min(size, largest_alignment_);
  const std::size_t aligned = (position_ + step - 1) / step * step;
  (void)take(aligned - position_);
}

template <int Bytes>
std::uint64_t MessageReader::number() {
  align(Bytes);
  const std::string_view bytes = take(Bytes);
  std::uint64_t value = 0;
  for (int k = 0; k < Bytes; ++k) {
    const int shift = 8 * (is_big_endian_ ? Bytes - 1 - k : k);
    value |= std::uint64_t{static_cast<unsigned char>(bytes[static_cast<std::size_t>(k)])} << shift;
  }
  return value;
}
template std::uint64_t MessageReader::number<4>();
template std::uint64_t MessageReader::number<8>();

std::string MessageReader::text() {
  std::string_view bytes = take(u32());
  // CDR counts the zero at the end; some writers leave out both for an empty text.
  if (serialization_ == Serialization::cdr && !bytes.empty()) bytes.remove_suffix(1);
  return std::string(bytes);
}

std::uint32_t MessageReader::list_size(std::uint32_t least_bytes) {
  const std::uint32_t count = u32();
  if (std::uint64_t{count} * least_bytes > left())
    fail(concat("a list promises ", count, " elements, ", left(), " bytes are left"));
  return count;
}

}  // namespace vantage
