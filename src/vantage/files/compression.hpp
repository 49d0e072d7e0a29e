#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace vantage {

/// What came out of compressed data, and why it ended before its end; an empty text where all is well. Data that is
/// damaged or cut off gives what came out before.
struct Unpacked {
  std::string bytes;
  std::string trouble;
};

/// Whether the bytes begin as a Zstandard frame does.
[[nodiscard]] bool is_zstd(std::string_view bytes);

// Each unpacks a whole compressed stream (Zstandard frames, an LZ4 frame, bzip2) into at most `limit` bytes. Memory
// grows with what comes out, whatever the stream promises.
[[nodiscard]] Unpacked unpack_zstd(std::string_view bytes, std::uint64_t limit);
[[nodiscard]] Unpacked unpack_lz4(std::string_view bytes, std::uint64_t limit);
[[nodiscard]] Unpacked unpack_bzip2(std::string_view bytes, std::uint64_t limit);

/// Unpacks a Zstandard file into another file of at most `limit` bytes and returns the trouble, as above.
[[nodiscard]] std::string unpack_zstd_file(const std::filesystem::path& from, const std::filesystem::path& to,
                                           std::uint64_t limit);

}  // namespace vantage
