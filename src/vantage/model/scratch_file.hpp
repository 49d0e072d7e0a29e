#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace vantage {

/// Bytes that are put aside: in a file without a name in the system's folder for temporary files, which is gone with
/// the process; in memory where no such file can be made or written. For one thread at a time.
class ScratchFile {
 public:
  ScratchFile();
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// A piece that was put aside.
  struct Piece {
    std::uint64_t offset = 0;
    std::size_t size = 0;
    std::shared_ptr<std::byte[]> memory = {};  // where it is not in the file
  };
  [[nodiscard]] Piece put(std::span<const std::byte> bytes);
  /// Fills `target`, which has the piece's size. Throws Error where the file cannot be read.
  void get(const Piece& piece, std::span<std::byte> target) const;

 private:
  int descriptor_ = -1;
  std::uint64_t end_ = 0;
};

}  // namespace vantage
