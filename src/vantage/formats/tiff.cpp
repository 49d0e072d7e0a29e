#include "vantage/formats/tiff.hpp"

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include "vantage/core/error.hpp"
#include "vantage/formats/half.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t tiff_longest_side = 16384;
constexpr std::uint64_t tiff_best_ratio = 33'000;  // zstd packs 128 kB of one byte into four
constexpr tmsize_t tiff_most_memory = tmsize_t{1} << 30;

/// The bytes of a file as the library asks for them, and what it says is wrong with them.
struct TiffInput {
  std::string_view bytes;
  std::uint64_t at = 0;
  std::string trouble;
};

tmsize_t read_tiff(thandle_t handle, void* target, tmsize_t size) {
  auto& input = *static_cast<TiffInput*>(handle);
  if (size <= 0 || input.at >= input.bytes.size()) return 0;
  const std::size_t count = std::min(static_cast<std::size_t>(size), input.bytes.size() - input.at);
  std::memcpy(target, input.bytes.data() + input.at, count);
  input.at += count;
  return static_cast<tmsize_t>(count);
}

toff_t seek_tiff(thandle_t handle, toff_t offset, int from) {
  auto& input = *static_cast<TiffInput*>(handle);
  const std::uint64_t base = from == SEEK_CUR ? input.at : from == SEEK_END ? input.bytes.size() : 0;
  input.at = base + offset;
  return input.at;
}

__attribute__((format(printf, 4, 0))) int note_tiff_error(TIFF*, void* user, const char*, const char* format,
                                                          va_list values) {
  std::array<char, 256> text{};
  (void)std::vsnprintf(text.data(), text.size(), format, values);
  std::string& trouble = static_cast<TiffInput*>(user)->trouble;
  if (trouble.empty()) trouble = text.data();  // what follows comes of it
  return 1;
}

int ignore_tiff_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

using TiffFile = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

TiffFile open_tiff(TiffInput& input, const std::string& name) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 TIFFOpenOptionsFree);
  if (options == nullptr) throw Error("libtiff could not be started");
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), tiff_most_memory);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), note_tiff_error, &input);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_tiff_warning, nullptr);
  TiffFile file(TIFFClientOpenExt(
                    name.c_str(), "rm", &input, read_tiff, [](thandle_t, void*, tmsize_t) { return tmsize_t{0}; },
                    seek_tiff, [](thandle_t) { return 0; },
                    [](thandle_t handle) -> toff_t { return static_cast<TiffInput*>(handle)->bytes.size(); }, nullptr,
                    nullptr, options.get()),
                TIFFClose);
  require(file != nullptr, name, ": is damaged or cut off: ", input.trouble);
  return file;
}

template <class Value>
Value tiff_field(const TiffFile& file, std::uint32_t tag) {
  Value value{};
  (void)TIFFGetFieldDefaulted(file.get(), tag, &value);
  return value;
}

/// How a TIFF file stores its image.
struct TiffHeader {
  std::uint32_t columns = 0, rows = 0;
  std::uint16_t bits = 0, format = 0;
  [[nodiscard]] std::size_t row_bytes() const { return std::size_t{columns} * (bits / 8U); }
};

TiffHeader read_tiff_header(const TiffFile& file, std::size_t file_size, const std::string& name,
                            std::int64_t most_pixels) {
  const TiffHeader header{
      .columns = tiff_field<std::uint32_t>(file, TIFFTAG_IMAGEWIDTH),
      .rows = tiff_field<std::uint32_t>(file, TIFFTAG_IMAGELENGTH),
      .bits = tiff_field<std::uint16_t>(file, TIFFTAG_BITSPERSAMPLE),
      .format = tiff_field<std::uint16_t>(file, TIFFTAG_SAMPLEFORMAT),
  };
  const auto channels = tiff_field<std::uint16_t>(file, TIFFTAG_SAMPLESPERPIXEL);
  require(channels == 1, name, ": has ", channels, " channels; a depth image must have one");
  const bool is_whole = (header.format == SAMPLEFORMAT_UINT || header.format == SAMPLEFORMAT_INT) && header.bits >= 16;
  require((is_whole && (header.bits == 16 || header.bits == 32)) ||
              (header.format == SAMPLEFORMAT_IEEEFP && (header.bits == 16 || header.bits == 32 || header.bits == 64)),
          name, ": has pixels of ", header.bits, " bits, sample format ", header.format,
          "; must be whole numbers of 16 or 32 bits, or floats of 16 to 64");
  const auto colours = tiff_field<std::uint16_t>(file, TIFFTAG_PHOTOMETRIC);
  require(colours == PHOTOMETRIC_MINISBLACK, name, ": has the photometric interpretation ", colours,
          "; must be 1 (0 is black)");
  const auto orientation = tiff_field<std::uint16_t>(file, TIFFTAG_ORIENTATION);
  require(orientation == ORIENTATION_TOPLEFT, name, ": has the orientation ", orientation,
          "; must be 1 (rows from the top, columns from the left)");
  constexpr std::array<std::uint16_t, 7> lossless{COMPRESSION_NONE,    COMPRESSION_LZW,      COMPRESSION_ADOBE_DEFLATE,
                                                  COMPRESSION_DEFLATE, COMPRESSION_PACKBITS, COMPRESSION_LZMA,
                                                  COMPRESSION_ZSTD};
  const auto compression = tiff_field<std::uint16_t>(file, TIFFTAG_COMPRESSION);
  require(std::find(lossless.begin(), lossless.end(), compression) != lossless.end(), name, ": has the compression ",
          compression, "; must be saved with LZW, deflate, PackBits, LZMA, zstd or none");
  require(header.columns >= 1 && header.rows >= 1 && header.columns <= tiff_longest_side &&
              header.rows <= tiff_longest_side,
          name, ": has ", header.columns, "x", header.rows, " pixels; must have 1 to ", tiff_longest_side,
          " on each side");
  require_pixels({static_cast<int>(header.columns), static_cast<int>(header.rows)}, most_pixels, name);
  const std::uint64_t ratio = compression == COMPRESSION_NONE ? 1 : tiff_best_ratio;
  require(header.row_bytes() * header.rows <= ratio * file_size, name, ": ", header.columns, "x", header.rows,
          " pixels are announced, which ", file_size, " bytes cannot hold; the file is cut off");
  return header;
}

/// Reads tiles or strips into rows of the image.
class TiffPixels {
 public:
  TiffPixels(const TiffFile& file, const TiffInput& input, const TiffHeader& header, const std::string& name)
      : file_(file), input_(input), header_(header), name_(name), pixels_(header.row_bytes() * header.rows, '\0') {
    if (TIFFIsTiled(file.get()) != 0) {
      read_tiles();
    } else {
      read_strips();
    }
  }
  [[nodiscard]] const std::string& bytes() const { return pixels_; }

 private:
  void check(tmsize_t got, std::size_t expected, const char* what, std::uint32_t number) const {
    if (got >= 0 && static_cast<std::size_t>(got) >= expected) return;
    throw InputError(fmt::format("{}: {} {} is damaged or cut off{}", name_, what, number,
                                 input_.trouble.empty() ? "" : ": " + input_.trouble));
  }

  void read_strips() {
    const std::uint32_t per_strip = std::min(tiff_field<std::uint32_t>(file_, TIFFTAG_ROWSPERSTRIP), header_.rows);
    require(per_strip > 0, name_, ": has strips of 0 rows");
    for (std::uint32_t row = 0, strip = 0; row < header_.rows; row += per_strip, ++strip) {
      const std::size_t size = header_.row_bytes() * std::min(per_strip, header_.rows - row);
      const tmsize_t got = TIFFReadEncodedStrip(file_.get(), strip, pixels_.data() + header_.row_bytes() * row,
                                                static_cast<tmsize_t>(size));
      check(got, size, "strip", strip);
    }
  }

  void read_tiles() {
    const auto width = tiff_field<std::uint32_t>(file_, TIFFTAG_TILEWIDTH);
    const auto height = tiff_field<std::uint32_t>(file_, TIFFTAG_TILELENGTH);
    require(width > 0 && height > 0 && width <= tiff_longest_side && height <= tiff_longest_side, name_,
            ": has tiles of ", width, "x", height, " pixels; must have 1 to ", tiff_longest_side, " on each side");
    const std::size_t pixel = header_.bits / 8U, tile_row = width * pixel, size = tile_row * height;
    require(size <= tiff_best_ratio * input_.bytes.size(), name_, ": has tiles of ", width, "x", height,
            " pixels, which ", input_.bytes.size(), " bytes cannot hold");
    std::string tile(size, '\0');
    for (std::uint32_t top = 0; top < header_.rows; top += height) {
      for (std::uint32_t left = 0; left < header_.columns; left += width) {
        const std::uint32_t number = TIFFComputeTile(file_.get(), left, top, 0, 0);
        check(TIFFReadEncodedTile(file_.get(), number, tile.data(), static_cast<tmsize_t>(size)), size, "tile", number);
        const std::size_t count = std::min(width, header_.columns - left) * pixel;
        for (std::uint32_t row = top; row < std::min(top + height, header_.rows); ++row) {
          std::copy_n(tile.data() + (row - top) * tile_row, count,
                      pixels_.data() + row * header_.row_bytes() + left * pixel);
        }
      }
    }
  }

  const TiffFile& file_;
  const TiffInput& input_;
  const TiffHeader& header_;
  const std::string& name_;
  std::string pixels_;
};

template <class Value, class Image, class Convert>
Image converted_tiff(const std::string& bytes, Resolution resolution, const Convert& convert) {
  Image image{resolution, {}};
  image.values.resize(static_cast<std::size_t>(resolution.rays()));
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    Value value{};
    std::memcpy(&value, bytes.data() + i * sizeof(Value), sizeof(Value));
    image.values[i] = convert(value, i);
  }
  return image;
}

template <class Value>
Gray16 whole_tiff(const std::string& bytes, Resolution resolution, const std::string& name) {
  return converted_tiff<Value, Gray16>(bytes, resolution, [&](Value value, std::size_t i) {
    require(std::in_range<std::uint16_t>(value), name, ": pixel ", i, " is ", std::int64_t{value},
            ": whole numbers must be within 0 and 65535");
    return static_cast<std::uint16_t>(value);
  });
}

template <class Value, class Convert>
FloatImage float_tiff(const std::string& bytes, Resolution resolution, const Convert& convert) {
  return converted_tiff<Value, FloatImage>(bytes, resolution,
                                           [&](Value value, std::size_t) -> float { return convert(value); });
}

DepthPixels pixels_of_tiff(const std::string& bytes, const TiffHeader& header, const std::string& name) {
  const Resolution size{static_cast<int>(header.columns), static_cast<int>(header.rows)};
  if (header.format == SAMPLEFORMAT_IEEEFP) {
    if (header.bits == 16) return float_tiff<std::uint16_t>(bytes, size, half_as_float);
    if (header.bits == 32) return float_tiff<float>(bytes, size, [](float value) { return value; });
    return float_tiff<double>(bytes, size, [](double value) { return static_cast<float>(value); });
  }
  const bool has_sign = header.format == SAMPLEFORMAT_INT;
  if (header.bits == 16 && has_sign) return whole_tiff<std::int16_t>(bytes, size, name);
  if (header.bits == 16) return whole_tiff<std::uint16_t>(bytes, size, name);
  if (has_sign) return whole_tiff<std::int32_t>(bytes, size, name);
  return whole_tiff<std::uint32_t>(bytes, size, name);
}

/// Smaller copies and masks may follow the image, another image may not.
void require_one_image(const TiffFile& file, const std::string& name) {
  if (TIFFReadDirectory(file.get()) != 1) return;
  const auto kind = tiff_field<std::uint32_t>(file, TIFFTAG_SUBFILETYPE);
  require((kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) != 0, name,
          ": has several pages; a depth image must be the only one");
}

}  // namespace

bool is_tiff(std::string_view bytes) {
  constexpr std::array<std::string_view, 4> magic{
      {{"II*\0", 4}, {"MM\0*", 4}, {"II+\0", 4}, {"MM\0+", 4}}};  // the last two: more than 4 GB
  return std::find(magic.begin(), magic.end(), bytes.substr(0, 4)) != magic.end();
}

DepthPixels decode_tiff(std::string_view bytes, const std::string& name, std::int64_t most_pixels) {
  require(is_tiff(bytes), name, ": is no TIFF file");
  TiffInput input{bytes, 0, {}};
  const TiffFile file = open_tiff(input, name);
  const TiffHeader header = read_tiff_header(file, bytes.size(), name, most_pixels);
  DepthPixels pixels = pixels_of_tiff(TiffPixels(file, input, header, name).bytes(), header, name);
  require_one_image(file, name);
  return pixels;
}

}  // namespace vantage
