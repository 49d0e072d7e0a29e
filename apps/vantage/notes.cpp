#include "notes.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "vantage/core/error.hpp"

namespace vantage::app {

void prepare_standard_streams() {
  std::signal(SIGPIPE, SIG_IGN);
  // What is read comes from nowhere, results cannot be written (which is an error), and notes are lost.
  for (const auto& [descriptor, flags] :
       {std::pair{STDIN_FILENO, O_RDONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_WRONLY}}) {
    if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    const int opened = ::open("/dev/null", flags);  // the lowest that is free: this one
    if (opened >= 0 && opened != descriptor) ::close(opened);
  }
}

void finish_standard_output() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0) return;
  throw Error(concat("standard output cannot be written", errno != 0 ? concat(": ", std::strerror(errno)) : ""));
}

}  // namespace vantage::app
