#include "vantage/files/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "vantage/core/error.hpp"

namespace vantage {

InputFile::InputFile(const std::filesystem::path& path) : name_(path.string()) {
  struct stat about {};
  // Opening a pipe would wait for somebody to write to it.
  require(stat(path.c_str(), &about) == 0, name_, ": ", std::strerror(errno));
  require(S_ISREG(about.st_mode), name_, ": is no regular file");
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  require(descriptor_ >= 0, name_, ": cannot be read: ", std::strerror(errno));
  size_ = static_cast<std::uint64_t>(about.st_size);
}

InputFile::~InputFile() { close(descriptor_); }

std::string InputFile::read(std::uint64_t offset, std::uint64_t count) const {
  if (offset >= size_) return {};
  std::string bytes(std::min(count, size_ - offset), '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error(concat(name_, ": cannot be read: ", std::strerror(errno)));
    if (got == 0) break;  // somebody made it shorter
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

}  // namespace vantage
