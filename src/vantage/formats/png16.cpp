#include "vantage/formats/png16.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr png_uint_32 png_longest_side = 16384;
constexpr std::size_t png_best_ratio = 1100;  // deflate packs at most 1032 bytes into one

/// What the callbacks of libpng need. libpng reports errors by longjmp, so everything that owns memory lives here and
/// not on the stack of the functions that are jumped out of.
struct Codec {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string_view input;
  std::string output;
  std::string error;
  Gray16 image;
  std::vector<png_byte> bytes;  // of an image of another kind, with equal bytes per row
};

void on_error(png_structp png, png_const_charp message) {
  static_cast<Codec*>(png_get_error_ptr(png))->error = message;
  std::longjmp(png_jmpbuf(png), 1);
}
void on_warning(png_structp, png_const_charp) {}  // about things like colour profiles, which depth does not have

void on_read(png_structp png, png_bytep target, std::size_t count) {
  std::string_view& input = static_cast<Codec*>(png_get_io_ptr(png))->input;
  if (input.size() < count) png_error(png, "the file is cut off");
  std::copy_n(input.begin(), count, target);
  input.remove_prefix(count);
}

void on_write(png_structp png, png_bytep bytes, std::size_t count) {
  static_cast<Codec*>(png_get_io_ptr(png))->output.append(bytes, bytes + count);
}
void on_flush(png_structp) {}

/// Runs one step; false where libpng reported an error.
bool succeeds(Codec& codec, void (*step)(Codec&)) {
  if (setjmp(png_jmpbuf(codec.png)) != 0) return false;
  step(codec);
  return true;
}

void read_header(Codec& codec) {
  png_set_read_fn(codec.png, &codec, on_read);
  png_set_user_limits(codec.png, png_longest_side, png_longest_side);
  // Texts and colour profiles say nothing about depth, and a thousand of them unpack to 8 MB each.
  png_set_keep_unknown_chunks(codec.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_read_info(codec.png, codec.info);
}

void read_rows(Codec& codec) {
  if constexpr (std::endian::native == std::endian::little) png_set_swap(codec.png);
  const int passes = png_set_interlace_handling(codec.png);
  png_read_update_info(codec.png, codec.info);
  const auto columns = static_cast<std::size_t>(codec.image.resolution.columns);
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t row = 0; row < static_cast<std::size_t>(codec.image.resolution.rows); ++row) {
      png_read_row(codec.png, reinterpret_cast<png_bytep>(codec.image.values.data() + row * columns), nullptr);
    }
  }
  png_read_end(codec.png, nullptr);
}

/// Every kind of image as one to four channels of one or two bytes.
void read_bytes(Codec& codec) {
  png_set_expand(codec.png);
  const int passes = png_set_interlace_handling(codec.png);
  png_read_update_info(codec.png, codec.info);
  const std::size_t row_bytes = png_get_rowbytes(codec.png, codec.info);
  const auto rows = static_cast<std::size_t>(codec.image.resolution.rows);
  codec.bytes.resize(row_bytes * rows);
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t row = 0; row < rows; ++row) png_read_row(codec.png, codec.bytes.data() + row * row_bytes, nullptr);
  }
  png_read_end(codec.png, nullptr);
}

void write_image(Codec& codec) {
  png_set_write_fn(codec.png, &codec, on_write, on_flush);
  png_set_IHDR(codec.png, codec.info, static_cast<png_uint_32>(codec.image.resolution.columns),
               static_cast<png_uint_32>(codec.image.resolution.rows), 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(codec.png, 3);  // twice as fast as the default and hardly larger
  png_write_info(codec.png, codec.info);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(codec.png);
  const auto columns = static_cast<std::size_t>(codec.image.resolution.columns);
  for (std::size_t row = 0; row < static_cast<std::size_t>(codec.image.resolution.rows); ++row) {
    png_write_row(codec.png, reinterpret_cast<png_const_bytep>(codec.image.values.data() + row * columns));
  }
  png_write_end(codec.png, codec.info);
}

/// Owns the reading half of libpng.
struct Reader : Codec {
  Reader() {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, static_cast<Codec*>(this), on_error, on_warning);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) throw Error("libpng could not be started");
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Writer : Codec {
  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, static_cast<Codec*>(this), on_error, on_warning);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) throw Error("libpng could not be started");
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

std::string describe(int color_type, int bit_depth) {
  const char* color = color_type == PNG_COLOR_TYPE_GRAY      ? "grey"
                      : color_type == PNG_COLOR_TYPE_PALETTE ? "palette"
                      : (color_type & PNG_COLOR_MASK_COLOR)  ? "colour"
                                                             : "grey with alpha";
  return fmt::format("{}, {} bits", color, bit_depth);
}

/// A reader that has read the header. Its image has the size, and no values yet.
void open(Reader& reader, std::string_view bytes, const std::string& name) {
  if (bytes.empty()) throw InputError(name + ": is empty");
  if (!is_png(bytes)) throw InputError(name + ": is not a PNG file");
  reader.input = bytes;
  if (!succeeds(reader, read_header)) throw InputError(fmt::format("{}: {}", name, reader.error));
  const std::size_t columns = png_get_image_width(reader.png, reader.info);
  const std::size_t rows = png_get_image_height(reader.png, reader.info);
  const std::size_t bits = png_get_bit_depth(reader.png, reader.info) * png_get_channels(reader.png, reader.info);
  if (columns * rows * bits / 8 > png_best_ratio * bytes.size()) {
    throw InputError(fmt::format("{}: {}x{} pixels are announced, which {} bytes cannot hold; the file is cut off",
                                 name, columns, rows, bytes.size()));
  }
  reader.image.resolution = {static_cast<int>(columns), static_cast<int>(rows)};
}

/// Reads an image of any kind that must have the size of a depth image.
void read_any(Reader& reader, std::string_view bytes, Resolution resolution, const std::string& name) {
  open(reader, bytes, name);
  const Resolution found = reader.image.resolution;
  if (!(found == resolution)) {
    throw InputError(fmt::format("{}: has {}x{} pixels, the depth image {}x{}; a mask must have the same", name,
                                 found.columns, found.rows, resolution.columns, resolution.rows));
  }
  if (!succeeds(reader, read_bytes)) throw InputError(fmt::format("{}: {}", name, reader.error));
}

/// Which of the pixels have a byte that is not 0 among `count` from `first` on.
Mask nonzero_pixels(const std::vector<png_byte>& bytes, std::size_t pixels, std::size_t first, std::size_t count) {
  Mask mask(pixels);
  const std::size_t step = bytes.size() / pixels;
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(i * step + first);
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    mask[i] = std::any_of(begin, end, [](png_byte value) { return value != 0; }) ? 1 : 0;
  }
  return mask;
}

}  // namespace

bool is_png(std::string_view bytes) {
  const std::size_t count = std::min<std::size_t>(8, bytes.size());
  return count > 0 && png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, count) == 0;
}

void require_pixels(Resolution resolution, std::int64_t most_pixels, const std::string& name) {
  require(resolution.rays() <= most_pixels, name, ": has ", resolution.columns, "x", resolution.rows,
          " pixels; must have at most ", most_pixels);
}

Gray16 decode_png16(std::string_view bytes, const std::string& name, std::int64_t most_pixels) {
  Reader reader;
  open(reader, bytes, name);
  require_pixels(reader.image.resolution, most_pixels, name);
  const int bit_depth = png_get_bit_depth(reader.png, reader.info);
  const int color_type = png_get_color_type(reader.png, reader.info);
  if (bit_depth != 16 || color_type != PNG_COLOR_TYPE_GRAY) {
    throw InputError(fmt::format("{}: is a PNG image of another kind ({}); depth must be grey, 16 bits", name,
                                 describe(color_type, bit_depth)));
  }
  reader.image.values.resize(static_cast<std::size_t>(reader.image.resolution.rays()));
  if (!succeeds(reader, read_rows)) throw InputError(fmt::format("{}: {}", name, reader.error));
  return std::move(reader.image);
}

std::vector<std::uint16_t> decode_png_grey(std::string_view bytes, Resolution resolution, const std::string& name) {
  Reader reader;
  read_any(reader, bytes, resolution, name);
  const auto pixels = static_cast<std::size_t>(resolution.rays());
  const std::size_t step = reader.bytes.size() / pixels;
  const bool is_wide = png_get_bit_depth(reader.png, reader.info) == 16;
  std::vector<std::uint16_t> values(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const png_byte* value = reader.bytes.data() + i * step;
    values[i] = is_wide ? static_cast<std::uint16_t>(value[0] << 8U | value[1]) : value[0];
  }
  return values;
}

Mask decode_png_mask(std::string_view bytes, Resolution resolution, const std::string& name) {
  Reader reader;
  read_any(reader, bytes, resolution, name);
  const auto pixels = static_cast<std::size_t>(resolution.rays());
  const std::size_t channels = png_get_channels(reader.png, reader.info);
  const std::size_t channel_bytes = reader.bytes.size() / pixels / channels;
  if (channels % 2 == 1) return nonzero_pixels(reader.bytes, pixels, 0, channels * channel_bytes);
  const std::size_t color_bytes = (channels - 1) * channel_bytes;
  const Mask opaque = nonzero_pixels(reader.bytes, pixels, color_bytes, channel_bytes);
  const bool is_cut_out = std::find(opaque.begin(), opaque.end(), 0) != opaque.end();
  return is_cut_out ? opaque : nonzero_pixels(reader.bytes, pixels, 0, color_bytes);
}

std::string encode_png16(const Gray16& image) {
  require(image.resolution.columns > 0 && image.resolution.rows > 0 &&
              image.values.size() == static_cast<std::size_t>(image.resolution.rays()),
          "image: ", image.values.size(), " values for ", image.resolution.columns, "x", image.resolution.rows,
          " pixels");
  Writer writer;
  writer.image = image;
  if (!succeeds(writer, write_image)) throw Error("writing a PNG image failed: " + writer.error);
  return std::move(writer.output);
}

}  // namespace vantage
