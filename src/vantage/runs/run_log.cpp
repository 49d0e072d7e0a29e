#include "vantage/runs/run_log.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"

namespace vantage {

RunLog::RunLog(const std::filesystem::path& folder) : path_(folder / file_name) {
  // A new file, so that a reader of the old one notices.
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw Error(concat("cannot write ", path_.string(), ": ", std::strerror(errno)));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor_);
    throw Error(concat(path_.string(), ": another run writes to this folder; choose another one with --out"));
  }
  if (::lseek(descriptor_, 0, SEEK_END) == 0) return;
  std::filesystem::remove(path_);
  ::close(descriptor_);
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
    throw Error(concat("cannot write ", path_.string(), ": ", std::strerror(errno)));
}

RunLog::~RunLog() {
  if (descriptor_ < 0) return;
  // Nothing was told: there is nothing to look at either.
  if (::lseek(descriptor_, 0, SEEK_END) == 0) ::unlink(path_.c_str());
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

void RunLog::remove() { std::filesystem::remove(path_); }

}  // namespace vantage
