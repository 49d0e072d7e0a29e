#include "vantage/files/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "vantage/core/error.hpp"

namespace vantage {

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& what_then)
    : descriptor_(::open((folder / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0)
    throw Error(fmt::format("{}: cannot be written to: {}", folder.string(), std::generic_category().message(errno)));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(descriptor_);
  throw Error(fmt::format("{}: {}", folder.string(), what_then));
}

FolderLock::~FolderLock() { ::close(descriptor_); }

}  // namespace vantage
