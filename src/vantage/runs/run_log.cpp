#include "vantage/runs/run_log.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"

namespace vantage {

bool RunLog::is_written(const std::filesystem::path& log) {
  const int descriptor = ::open(log.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return false;
  const bool locked = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0;
  ::close(descriptor);
  return locked;
}

RunLog::RunLog(const std::filesystem::path& folder) : path_(folder / file_name) {
  const auto fail = [this](const std::filesystem::path& aside) {
    const int error_number = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!aside.empty()) ::unlink(aside.c_str());
    throw Error(concat("cannot write ", path_.string(), ": ", std::strerror(error_number)));
  };
  if (is_written(path_))
    throw Error(concat(path_.string(), ": another run writes to this folder; choose another one with --out"));
  // Locked before it has its name: nobody ever sees it without, and nobody who looks whether it is locked is in the
  // way.
  const std::filesystem::path aside = folder / concat(".", file_name, ".", ::getpid(), "-0.tmp");
  descriptor_ = ::open(aside.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail({});
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) fail(aside);
  if (::rename(aside.c_str(), path_.c_str()) != 0) fail(aside);
}

bool RunLog::is_mine() const {
  struct stat mine {
  }, there{};
  return ::fstat(descriptor_, &mine) == 0 && ::stat(path_.c_str(), &there) == 0 && mine.st_ino == there.st_ino &&
         mine.st_dev == there.st_dev;
}

RunLog::~RunLog() {
  if (::lseek(descriptor_, 0, SEEK_END) == 0 && is_mine()) ::unlink(path_.c_str());
  ::close(descriptor_);
}

void RunLog::add(std::string_view event, const nlohmann::ordered_json& data) {
  using Json = nlohmann::ordered_json;
  const std::string text =
      concat(R"({"event":")", event, R"(","data":)", data.dump(-1, ' ', false, Json::error_handler_t::replace), "}\n");
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t written = ::write(descriptor_, text.data() + at, text.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw Error(concat("cannot write ", path_.string(), ": ", std::strerror(errno)));
    at += static_cast<std::size_t>(written);
  }
}

void RunLog::remove() {
  if (is_mine()) ::unlink(path_.c_str());
}

}  // namespace vantage
