#include "vantage/files/compression.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <vector>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t piece = std::uint64_t{1} << 16;
// A window of 128 MiB is what the format's own program accepts without being asked to.
constexpr int largest_window_log = 27;

/// What one step of a decoder did.
struct Step {
  std::size_t taken = 0, given = 0;
  bool at_end = false;  // of a frame
  std::string error;
};

/// Runs a decoder over all the bytes; `step(in, out, room)` unpacks into `room` bytes at `out`.
template <class Decode>
Unpacked unpack(std::string_view bytes, std::uint64_t limit, const Decode& step) {
  Unpacked result;
  std::string& out = result.bytes;
  std::size_t filled = 0;
  while (result.trouble.empty()) {
    // One byte beyond the limit tells that there is more.
    if (out.size() - filled < piece)
      out.resize(std::min(limit + 1, std::max<std::uint64_t>(2 * out.size(), 4 * piece)));
    const Step done = step(bytes, out.data() + filled, out.size() - filled);
    bytes.remove_prefix(done.taken);
    filled += done.given;
    if (!done.error.empty()) {
      result.trouble = "is damaged (" + done.error + ")";
    } else if (filled > limit) {
      result.trouble = concat("gives more than ", limit, " bytes");
    } else if (done.at_end && bytes.empty()) {
      break;
    } else if (done.taken == 0 && done.given == 0) {
      result.trouble = "is cut off";
    }
  }
  out.resize(std::min<std::uint64_t>(filled, limit));
  return result;
}

using ZstdStream = std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)>;

ZstdStream zstd_stream() {
  ZstdStream stream(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (stream == nullptr) throw Error("no memory to unpack Zstandard data");
  ZSTD_DCtx_setParameter(stream.get(), ZSTD_d_windowLogMax, largest_window_log);
  return stream;
}

Step zstd_step(ZSTD_DCtx& stream, std::string_view in, char* out, std::size_t room) {
  ZSTD_inBuffer input{in.data(), in.size(), 0};
  ZSTD_outBuffer output{out, room, 0};
  const std::size_t rest = ZSTD_decompressStream(&stream, &output, &input);
  return {input.pos, output.pos, rest == 0, ZSTD_isError(rest) != 0 ? ZSTD_getErrorName(rest) : ""};
}

}  // namespace

bool is_zstd(std::string_view bytes) { return bytes.substr(0, 4) == "\x28\xB5\x2F\xFD"; }

Unpacked unpack_zstd(std::string_view bytes, std::uint64_t limit) {
  const ZstdStream stream = zstd_stream();
  return unpack(bytes, limit,
                [&](std::string_view in, char* out, std::size_t room) { return zstd_step(*stream, in, out, room); });
}

Unpacked unpack_lz4(std::string_view bytes, std::uint64_t limit) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0)
    throw Error("no memory to unpack LZ4 data");
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> stream(made, LZ4F_freeDecompressionContext);
  return unpack(bytes, limit, [&](std::string_view in, char* out, std::size_t room) {
    std::size_t taken = in.size(), given = room;
    const std::size_t rest = LZ4F_decompress(stream.get(), out, &given, in.data(), &taken, nullptr);
    if (LZ4F_isError(rest) != 0) return Step{0, 0, false, LZ4F_getErrorName(rest)};
    return Step{taken, given, rest == 0, ""};
  });
}

Unpacked unpack_bzip2(std::string_view bytes, std::uint64_t limit) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw Error("no memory to unpack bzip2 data");
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> cleanup(&stream, BZ2_bzDecompressEnd);
  return unpack(bytes, limit, [&](std::string_view in, char* out, std::size_t room) {
    constexpr std::size_t most = std::size_t{1} << 30;
    const auto given_in = static_cast<unsigned>(std::min(in.size(), most));
    const auto given_room = static_cast<unsigned>(std::min(room, most));
    stream.next_in = const_cast<char*>(in.data());  // the library only reads it; its interface is older than const
    stream.avail_in = given_in;
    stream.next_out = out;
    stream.avail_out = given_room;
    const int result = BZ2_bzDecompress(&stream);
    const bool is_good = result == BZ_OK || result == BZ_STREAM_END;
    return Step{given_in - stream.avail_in, given_room - stream.avail_out, result == BZ_STREAM_END,
                is_good ? "" : concat("bzip2 error ", result)};
  });
}

std::string unpack_zstd_file(const std::filesystem::path& from, const std::filesystem::path& to, std::uint64_t limit) {
  std::ifstream in(from, std::ios::binary);
  require(in.good(), from.string(), ": cannot be read");
  std::ofstream out(to, std::ios::binary);
  const ZstdStream stream = zstd_stream();
  std::vector<char> packed(piece), unpacked(piece);
  std::uint64_t written = 0;
  bool at_end = true;
  while (in.read(packed.data(), static_cast<std::streamsize>(piece)) || in.gcount() > 0) {
    std::string_view rest(packed.data(), static_cast<std::size_t>(in.gcount()));
    for (bool is_full = false; !rest.empty() || is_full;) {
      const Step done = zstd_step(*stream, rest, unpacked.data(), unpacked.size());
      if (!done.error.empty()) return concat("is damaged after ", written, " unpacked bytes (", done.error, ")");
      written += done.given;
      require(written <= limit, from.string(), ": unpacks to more than ", limit, " bytes");
      out.write(unpacked.data(), static_cast<std::streamsize>(done.given));
      rest.remove_prefix(done.taken);
      at_end = done.at_end;
      is_full = done.given == unpacked.size();
    }
  }
  if (in.bad()) throw Error(concat(from.string(), ": cannot be read any further"));
  out.close();
  if (!out) throw Error(concat(to.string(), ": cannot be written; is the disk full?"));
  return at_end && written > 0 ? "" : concat("is cut off after ", written, " unpacked bytes");
}

}  // namespace vantage
