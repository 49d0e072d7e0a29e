#include "vantage/formats/exr.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"

// The layout of the file: https://openexr.com/en/latest/OpenEXRFileLayout.html
namespace vantage {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie in the file");

constexpr std::uint32_t magic = 20000630;
constexpr std::int64_t exr_longest_side = 16384;
constexpr std::uint64_t exr_best_ratio = 1100;  // deflate packs at most 1032 bytes into one
constexpr std::size_t most_channels = 64;
constexpr std::size_t most_bytes_per_pixel = 64;

enum class PixelType { unsigned_integer, half, single };

struct Channel {
  std::string name;
  PixelType type = PixelType::single;
  [[nodiscard]] std::size_t bytes() const { return type == PixelType::half ? 2 : 4; }
};

constexpr std::array compressions{"none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"};
enum Compression : unsigned char { none, rle, zips, zip };

/// Takes numbers and words off the front of bytes.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

  template <class Value>
  Value take() {
    Value value{};
    std::memcpy(&value, take(sizeof(Value)).data(), sizeof(Value));
    return value;
  }
  std::string_view take(std::size_t count) {
    require(count <= rest_.size(), name_, ": is cut off");
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  /// Up to the zero that ends it.
  std::string_view word() {
    const std::size_t end = rest_.find('\0');
    require(end != std::string_view::npos && end <= 255, name_, ": a name in its header does not end");
    const std::string_view taken = take(end);
    rest_.remove_prefix(1);
    return taken;
  }
  [[nodiscard]] bool empty() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  const std::string& name_;
};

struct Window {
  std::int32_t left = 0, top = 0, right = -1, bottom = -1;
  friend bool operator==(const Window&, const Window&) = default;
};

struct ExrHeader {
  std::vector<Channel> channels;
  std::optional<Window> data, display;
  Compression compression = none;
};

std::vector<Channel> read_channels(std::string_view bytes, const std::string& name) {
  ByteReader reader(bytes, name);
  std::vector<Channel> channels;
  while (true) {
    const std::string_view word = reader.word();
    if (word.empty()) return channels;
    require(channels.size() < most_channels, name, ": has more than ", most_channels, " channels");
    const auto type = reader.take<std::uint32_t>();
    require(type <= 2, name, ": channel ", in_quotes(word), " has pixels of the unknown type ", type);
    (void)reader.take(4);
    const auto x = reader.take<std::int32_t>(), y = reader.take<std::int32_t>();
    require(x == 1 && y == 1, name, ": channel ", in_quotes(word), " has not every pixel; must be saved in full size");
    channels.push_back({std::string(word), static_cast<PixelType>(type)});
  }
}

Compression checked_compression(std::uint8_t number, const std::string& name) {
  require(number < compressions.size(), name, ": has an unknown compression, number ", int{number});
  require(number <= zip, name, ": is compressed by ", compressions[number],
          "; must be saved with ZIP, ZIPS, RLE or no compression");
  return static_cast<Compression>(number);
}

ExrHeader read_exr_header(ByteReader& reader, const std::string& name) {
  ExrHeader header;
  while (true) {
    const std::string_view key = reader.word();
    if (key.empty()) return header;
    (void)reader.word();  // its type
    const auto size = reader.take<std::uint32_t>();
    const std::string_view bytes = reader.take(size);
    ByteReader value(bytes, name);
    if (key == "channels") header.channels = read_channels(bytes, name);
    if (key == "compression") header.compression = checked_compression(value.take<std::uint8_t>(), name);
    if (key == "dataWindow") header.data = value.take<Window>();
    if (key == "displayWindow") header.display = value.take<Window>();
  }
}

Resolution resolution_of(const ExrHeader& header, const std::string& name) {
  require(header.data && header.display && !header.channels.empty(), name,
          ": its header has no channels, dataWindow or displayWindow");
  const Window& window = *header.data;
  const std::int64_t columns = std::int64_t{window.right} - window.left + 1;
  const std::int64_t rows = std::int64_t{window.bottom} - window.top + 1;
  require(columns > 0 && rows > 0 && columns <= exr_longest_side && rows <= exr_longest_side, name, ": has ", columns,
          "x", rows, " pixels; must have 1 to ", exr_longest_side, " on each side");
  require(window == *header.display, name, ": holds only a part of its image; must be saved uncropped");
  return {static_cast<int>(columns), static_cast<int>(rows)};
}

/// Index of the channel with the depth.
std::size_t depth_channel(const std::vector<Channel>& channels, const std::string& name) {
  if (channels.size() == 1) return 0;
  for (const std::string wanted : {"Z", "Y"}) {
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (channels[i].name == wanted || channels[i].name.ends_with("." + wanted)) return i;
    }
  }
  std::string names;
  for (const Channel& channel : channels) names += (names.empty() ? "" : ", ") + in_quotes(channel.name);
  throw InputError(concat(name, ": has the channels ", names, "; depth must be the only one, or called Z or Y"));
}

std::string unpacked_runs(std::string_view packed, std::size_t size, const std::string& name) {
  std::string bytes;
  bytes.reserve(size);
  ByteReader reader(packed, name);
  while (!reader.empty()) {
    const int count = reader.take<std::int8_t>();
    if (count < 0) {
      bytes.append(reader.take(static_cast<std::size_t>(-count)));
    } else {
      bytes.append(static_cast<std::size_t>(count) + 1, reader.take<char>());
    }
    require(bytes.size() <= size, name, ": its compressed data is damaged");
  }
  return bytes;
}

std::string inflated(std::string_view packed, std::size_t size, const std::string& name) {
  std::string bytes(size, '\0');
  uLongf length = size;
  const int status = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                                reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  require(status == Z_OK, name, ": its compressed data is damaged");
  bytes.resize(length);
  return bytes;
}

/// The bytes of the scan lines of a chunk.
std::string unpacked(std::string_view packed, std::size_t size, Compression compression, const std::string& name) {
  // What does not get smaller is stored as it is.
  if (compression == none || packed.size() == size) return std::string(packed);
  std::string bytes = compression == rle ? unpacked_runs(packed, size, name) : inflated(packed, size, name);
  require(bytes.size() == size, name, ": its compressed data is damaged");
  // Each byte was replaced by its difference to the one before, after the bytes at even places were put in front.
  for (std::size_t i = 1; i < size; ++i) {
    const auto before = static_cast<unsigned char>(bytes[i - 1]), difference = static_cast<unsigned char>(bytes[i]);
    bytes[i] = static_cast<char>(before + difference - 128);
  }
  std::string result(size, '\0');
  for (std::size_t i = 0; i < size; ++i) result[i] = bytes[i % 2 == 0 ? i / 2 : (size + 1) / 2 + i / 2];
  return result;
}

float value_of(std::uint32_t single) { return std::bit_cast<float>(single); }

float value_of(std::uint16_t half) {
  const int exponent = (half >> 10U) & 31U;
  const auto fraction = static_cast<float>(half & 1023U);
  const float magnitude = exponent == 31  ? (fraction == 0 ? HUGE_VALF : NAN)
                          : exponent == 0 ? std::ldexp(fraction, -24)
                                          : std::ldexp(1024 + fraction, exponent - 25);
  return (half & 0x8000U) == 0 ? magnitude : -magnitude;
}

template <class Stored, class Convert>
void copy_row(const char* from, float* to, int columns, Convert convert) {
  for (int column = 0; column < columns; ++column, from += sizeof(Stored)) {
    Stored stored{};
    std::memcpy(&stored, from, sizeof(Stored));
    to[column] = convert(stored);
  }
}

void copy_pixels(const char* from, float* to, int columns, PixelType type) {
  if (type == PixelType::half) {
    copy_row<std::uint16_t>(from, to, columns, [](std::uint16_t half) { return value_of(half); });
  } else if (type == PixelType::single) {
    copy_row<std::uint32_t>(from, to, columns, [](std::uint32_t single) { return value_of(single); });
  } else {
    copy_row<std::uint32_t>(from, to, columns, [](std::uint32_t number) { return static_cast<float>(number); });
  }
}

}  // namespace

bool is_exr(std::string_view bytes) {
  std::uint32_t first = 0;
  if (bytes.size() < sizeof(first)) return false;
  std::memcpy(&first, bytes.data(), sizeof(first));
  return first == magic;
}

FloatImage decode_exr(std::string_view bytes, const std::string& name, std::int64_t most_pixels) {
  require(is_exr(bytes), name, ": is not an OpenEXR file");
  ByteReader reader(bytes.substr(sizeof(magic)), name);
  const auto version = reader.take<std::uint32_t>();
  require((version & 0xffU) == 2, name, ": is OpenEXR of version ", version & 0xffU, "; must be version 2");
  require((version & 0x1a00U) == 0, name, ": has tiles, deep pixels or several parts; must be saved as scan lines");
  const ExrHeader header = read_exr_header(reader, name);
  FloatImage image;
  image.resolution = resolution_of(header, name);
  require_pixels(image.resolution, most_pixels, name);
  const std::size_t chosen = depth_channel(header.channels, name);
  const auto columns = static_cast<std::size_t>(image.resolution.columns);
  const auto rows = static_cast<std::size_t>(image.resolution.rows);
  std::size_t row_bytes = 0, offset_in_row = 0;
  for (std::size_t i = 0; i < header.channels.size(); ++i) {
    if (i == chosen) offset_in_row = row_bytes;
    row_bytes += columns * header.channels[i].bytes();
  }
  require(row_bytes * rows <= exr_best_ratio * bytes.size(), name, ": ", columns, "x", rows,
          " pixels are announced, which ", bytes.size(), " bytes cannot hold; the file is cut off");
  require(row_bytes * rows / most_bytes_per_pixel <= static_cast<std::uint64_t>(most_pixels), name,
          ": its channels have ", row_bytes * rows, " bytes; must have at most ", most_bytes_per_pixel, " for each of ",
          most_pixels, " pixels");
  image.values.resize(columns * rows);
  const std::size_t lines = header.compression == zip ? 16 : 1;
  const std::size_t chunks = (rows + lines - 1) / lines;
  ByteReader offsets(reader.take(chunks * sizeof(std::uint64_t)), name);
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    const auto offset = offsets.take<std::uint64_t>();
    require(offset < bytes.size(), name, ": is cut off");
    ByteReader at(bytes.substr(offset), name);
    const std::size_t first = chunk * lines, count = std::min(lines, rows - first);
    const auto line = at.take<std::int32_t>();
    require(line - std::int64_t{header.data->top} == static_cast<std::int64_t>(first), name,
            ": its table of scan lines is damaged");
    const auto size = at.take<std::uint32_t>();
    const std::string pixels = unpacked(at.take(size), count * row_bytes, header.compression, name);
    require(pixels.size() == count * row_bytes, name, ": a scan line is cut off");
    for (std::size_t row = 0; row < count; ++row) {
      copy_pixels(pixels.data() + row * row_bytes + offset_in_row, image.values.data() + (first + row) * columns,
                  image.resolution.columns, header.channels[chosen].type);
    }
  }
  return image;
}

}  // namespace vantage
