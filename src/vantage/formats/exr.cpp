#include "vantage/formats/exr.hpp"

#include <openexr.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"

namespace vantage {
namespace {

constexpr std::int64_t exr_longest_side = 16384;
constexpr std::uint64_t exr_best_ratio = 1100;  // deflate packs at most 1032 bytes into one
constexpr int most_channels = 64;
constexpr std::size_t most_bytes_per_pixel = 64;

/// The bytes of a file as the library asks for them, and what it says is wrong with them.
struct ExrInput {
  std::string_view bytes;
  std::string trouble;
};

/// The file in the library's hands. The library takes as much memory as a header promises, which is bounded here by
/// what a file of that size can hold.
class OpenExr {
 public:
  OpenExr(std::string_view bytes, const std::string& name) : input_{bytes, {}}, name_(name) {
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.user_data = &input_;
    start.read_fn = read;
    start.size_fn = [](exr_const_context_t, void* input) {
      return static_cast<std::int64_t>(static_cast<ExrInput*>(input)->bytes.size());
    };
    start.error_handler_fn = note;
    start.alloc_fn = [](std::size_t size) { return size <= most_memory ? std::malloc(size) : nullptr; };
    start.free_fn = [](void* memory) { std::free(memory); };
    start.max_image_width = start.max_image_height = exr_longest_side;
    start.max_tile_width = start.max_tile_height = exr_longest_side;
    start.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    check(exr_start_read(&context_, name.c_str(), &start));
  }
  OpenExr(const OpenExr&) = delete;
  OpenExr& operator=(const OpenExr&) = delete;
  ~OpenExr() { exr_finish(&context_); }

  [[nodiscard]] exr_const_context_t get() const { return context_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t file_size() const { return input_.bytes.size(); }

  void check(exr_result_t result) const {
    if (result == EXR_ERR_SUCCESS) return;
    throw InputError(concat(name_, ": is damaged or cut off: ",
                            input_.trouble.empty() ? exr_get_default_error_message(result) : input_.trouble));
  }

 private:
  static constexpr std::size_t most_memory = std::size_t{1} << 28U;

  /// The library reads ahead, so that fewer bytes than it asks for are no error yet.
  static std::int64_t read(exr_const_context_t, void* user, void* target, std::uint64_t size, std::uint64_t offset,
                           exr_stream_error_func_ptr_t) {
    const std::string_view bytes = static_cast<ExrInput*>(user)->bytes;
    const std::uint64_t count = offset < bytes.size() ? std::min<std::uint64_t>(size, bytes.size() - offset) : 0;
    if (count > 0) std::memcpy(target, bytes.data() + offset, count);
    return static_cast<std::int64_t>(count);
  }
  static void note(exr_const_context_t context, exr_result_t, const char* message) {
    void* input = nullptr;
    if (exr_get_user_data(context, &input) != EXR_ERR_SUCCESS || input == nullptr) return;
    std::string& trouble = static_cast<ExrInput*>(input)->trouble;
    if (trouble.empty()) trouble = message;  // what follows comes of it
  }

  ExrInput input_;
  std::string name_;
  exr_context_t context_ = nullptr;
};

/// A step of decoding, whose buffers the library owns.
class ExrChunk {
 public:
  ExrChunk(const OpenExr& file, const exr_chunk_info_t& info) : file_(file) {
    require(info.unpacked_size <= exr_best_ratio * file.file_size(), file.name(), ": ", info.unpacked_size,
            " bytes of pixels are announced, which ", file.file_size(),
            " bytes cannot hold; the file is damaged or cut off");
    file.check(exr_decoding_initialize(file.get(), 0, &info, &pipeline_));
  }
  ExrChunk(const ExrChunk&) = delete;
  ExrChunk& operator=(const ExrChunk&) = delete;
  ~ExrChunk() { (void)exr_decoding_destroy(file_.get(), &pipeline_); }

  /// Decodes channel `chosen` to where the chunk's first pixel lies.
  void decode(int chosen, float* target, int columns) {
    for (int i = 0; i < pipeline_.channel_count; ++i) pipeline_.channels[i].decode_to_ptr = nullptr;
    exr_coding_channel_info_t& channel = pipeline_.channels[chosen];
    channel.decode_to_ptr = reinterpret_cast<std::uint8_t*>(target);
    channel.user_bytes_per_element = sizeof(float);
    channel.user_data_type = channel.data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
    channel.user_pixel_stride = sizeof(float);
    channel.user_line_stride = columns * static_cast<int>(sizeof(float));
    file_.check(exr_decoding_choose_default_routines(file_.get(), 0, &pipeline_));
    file_.check(exr_decoding_run(file_.get(), 0, &pipeline_));
  }

 private:
  const OpenExr& file_;
  exr_decode_pipeline_t pipeline_ = EXR_DECODE_PIPELINE_INITIALIZER;
};

struct ExrHeader {
  const exr_attr_chlist_t* channels = nullptr;
  exr_attr_box2i_t window{};
  bool is_tiled = false;
  Resolution resolution{0, 0};
};

ExrHeader read_exr_header(const OpenExr& file) {
  const std::string& name = file.name();
  int parts = 0;
  file.check(exr_get_count(file.get(), &parts));
  exr_storage_t storage = EXR_STORAGE_SCANLINE;
  file.check(exr_get_storage(file.get(), 0, &storage));
  require(parts == 1 && (storage == EXR_STORAGE_SCANLINE || storage == EXR_STORAGE_TILED), name,
          ": has deep pixels or several parts; must be one flat image");
  ExrHeader header;
  header.is_tiled = storage == EXR_STORAGE_TILED;
  exr_compression_t compression = EXR_COMPRESSION_NONE;
  file.check(exr_get_compression(file.get(), 0, &compression));
  constexpr std::array names{"none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"};
  const auto number = static_cast<std::size_t>(compression);
  require(compression <= EXR_COMPRESSION_PXR24, name, ": is compressed by ",
          number < names.size() ? names[number] : "an unknown method",
          ", which changes depths; must be saved with ZIP, ZIPS, PIZ, PXR24, RLE or no compression");
  exr_attr_box2i_t display{};
  file.check(exr_get_channels(file.get(), 0, &header.channels));
  file.check(exr_get_data_window(file.get(), 0, &header.window));
  file.check(exr_get_display_window(file.get(), 0, &display));
  const std::int64_t columns = std::int64_t{header.window.max.x} - header.window.min.x + 1;
  const std::int64_t rows = std::int64_t{header.window.max.y} - header.window.min.y + 1;
  require(columns > 0 && rows > 0 && columns <= exr_longest_side && rows <= exr_longest_side, name, ": has ", columns,
          "x", rows, " pixels; must have 1 to ", exr_longest_side, " on each side");
  require(std::memcmp(&header.window, &display, sizeof(display)) == 0, name,
          ": holds only a part of its image; must be saved uncropped");
  header.resolution = {static_cast<int>(columns), static_cast<int>(rows)};
  return header;
}

std::string_view name_of(const exr_attr_chlist_entry_t& channel) {
  return {channel.name.str, static_cast<std::size_t>(channel.name.length)};
}

/// Index of the channel with the depth.
int depth_channel(const exr_attr_chlist_t& channels, const std::string& name) {
  require(channels.num_channels <= most_channels, name, ": has ", channels.num_channels, " channels; must be at most ",
          most_channels);
  std::string names;
  for (int i = 0; i < channels.num_channels; ++i) {
    const exr_attr_chlist_entry_t& channel = channels.entries[i];
    require(channel.x_sampling == 1 && channel.y_sampling == 1, name, ": channel ", in_quotes(name_of(channel)),
            " has not every pixel; must be saved in full size");
    names += (names.empty() ? "" : ", ") + in_quotes(name_of(channel));
  }
  if (channels.num_channels == 1) return 0;
  for (const std::string wanted : {"Z", "Y"}) {
    for (int i = 0; i < channels.num_channels; ++i) {
      const std::string_view channel = name_of(channels.entries[i]);
      if (channel == wanted || channel.ends_with("." + wanted)) return i;
    }
  }
  throw InputError(concat(name, ": has the channels ", names, "; depth must be the only one, or called Z or Y"));
}

void require_sizes(const ExrHeader& header, const OpenExr& file, std::int64_t most_pixels) {
  require_pixels(header.resolution, most_pixels, file.name());
  std::size_t bytes = 0;
  for (int i = 0; i < header.channels->num_channels; ++i) {
    const bool is_half = header.channels->entries[i].pixel_type == EXR_PIXEL_HALF;
    bytes += static_cast<std::size_t>(header.resolution.rays()) * (is_half ? 2 : 4);
  }
  require(bytes <= exr_best_ratio * file.file_size(), file.name(), ": ", header.resolution.columns, "x",
          header.resolution.rows, " pixels are announced, which ", file.file_size(),
          " bytes cannot hold; the file is cut off");
  require(bytes / most_bytes_per_pixel <= static_cast<std::uint64_t>(most_pixels), file.name(), ": its channels have ",
          bytes, " bytes; must have at most ", most_bytes_per_pixel, " for each of ", most_pixels, " pixels");
}

void decode_scan_lines(const OpenExr& file, const ExrHeader& header, int chosen, FloatImage& image) {
  std::int32_t lines = 0;
  file.check(exr_get_scanlines_per_chunk(file.get(), 0, &lines));
  for (std::int64_t y = header.window.min.y; y <= header.window.max.y; y += lines) {
    exr_chunk_info_t info{};
    file.check(exr_read_scanline_chunk_info(file.get(), 0, static_cast<int>(y), &info));
    const std::int64_t row = y - header.window.min.y;
    ExrChunk(file, info).decode(chosen, image.values.data() + row * image.resolution.columns, image.resolution.columns);
  }
}

void decode_tiles(const OpenExr& file, int chosen, FloatImage& image) {
  std::int32_t width = 0, height = 0;
  file.check(exr_get_tile_sizes(file.get(), 0, 0, 0, &width, &height));  // of the largest level
  const auto [columns, rows] = image.resolution;
  for (int top = 0; top < rows; top += height) {
    for (int left = 0; left < columns; left += width) {
      exr_chunk_info_t info{};
      file.check(exr_read_tile_chunk_info(file.get(), 0, left / width, top / height, 0, 0, &info));
      float* target = image.values.data() + std::int64_t{top} * columns + left;
      ExrChunk(file, info).decode(chosen, target, columns);
    }
  }
}

}  // namespace

bool is_exr(std::string_view bytes) { return bytes.substr(0, 4) == std::string_view("\x76\x2f\x31\x01", 4); }

FloatImage decode_exr(std::string_view bytes, const std::string& name, std::int64_t most_pixels) {
  require(is_exr(bytes), name, ": is not an OpenEXR file");
  const OpenExr file(bytes, name);
  const ExrHeader header = read_exr_header(file);
  const int chosen = depth_channel(*header.channels, name);
  require_sizes(header, file, most_pixels);
  FloatImage image{header.resolution, std::vector<float>(static_cast<std::size_t>(header.resolution.rays()))};
  if (header.is_tiled) {
    decode_tiles(file, chosen, image);
  } else {
    decode_scan_lines(file, header, chosen, image);
  }
  if (header.channels->entries[chosen].pixel_type == EXR_PIXEL_UINT) {
    for (float& value : image.values) {
      std::uint32_t number = 0;
      std::memcpy(&number, &value, sizeof(number));
      value = static_cast<float>(number);
    }
  }
  return image;
}

}  // namespace vantage
