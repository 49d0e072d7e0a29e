#include "vantage/model/scratch_file.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include "vantage/core/error.hpp"

namespace vantage {

ScratchFile::ScratchFile() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) return;
  std::string name = (folder / "vantage-scans-XXXXXX").string();
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ >= 0) ::unlink(name.c_str());
}

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

ScratchFile::Piece ScratchFile::put(std::span<const std::byte> bytes) {
  std::size_t written = 0;
  while (descriptor_ >= 0 && written < bytes.size()) {
    const ssize_t count =
        ::pwrite(descriptor_, bytes.data() + written, bytes.size() - written, static_cast<off_t>(end_ + written));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;  // the disk is full
    written += static_cast<std::size_t>(count);
  }
  if (descriptor_ < 0 || written < bytes.size()) {
    Piece piece{0, bytes.size(), std::shared_ptr<std::byte[]>(new std::byte[bytes.size()])};
    std::copy(bytes.begin(), bytes.end(), piece.memory.get());
    return piece;
  }
  const Piece piece{end_, bytes.size()};
  end_ += bytes.size();
  return piece;
}

void ScratchFile::get(const Piece& piece, std::span<std::byte> target) const {
  if (piece.memory) {
    std::copy_n(piece.memory.get(), piece.size, target.begin());
    return;
  }
  for (std::size_t read = 0; read < piece.size;) {
    const ssize_t count =
        ::pread(descriptor_, target.data() + read, piece.size - read, static_cast<off_t>(piece.offset + read));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw Error("a scan that was put aside cannot be read again");
    read += static_cast<std::size_t>(count);
  }
}

}  // namespace vantage
