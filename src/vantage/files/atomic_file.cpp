#include "vantage/files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 20U;

std::string reason(int error_number) { return std::generic_category().message(error_number); }

/// Closes a descriptor that was only read from, where a failure to close loses nothing.
struct Descriptor {
  int number;
  explicit Descriptor(int n) : number(n) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

int open_folder(const std::filesystem::path& folder) {
  return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

/// Of the unfinished file, before the process and the attempt.
std::string unfinished_prefix(const std::filesystem::path& path) {
  return fmt::format(".{}.", path.filename().string());
}
constexpr std::string_view unfinished_ending = ".tmp";

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  // O_NONBLOCK: opening a pipe that nobody writes to must fail below rather than wait for ever.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number < 0) throw InputError(fmt::format("{}: cannot be read: {}", path.string(), reason(errno)));
  struct stat status {};
  if (::fstat(file.number, &status) != 0) throw Error(fmt::format("{}: {}", path.string(), reason(errno)));
  if (S_ISDIR(status.st_mode)) throw InputError(fmt::format("{}: is a folder, must be a file", path.string()));
  if (!S_ISREG(status.st_mode)) throw InputError(fmt::format("{}: is not a regular file", path.string()));
  std::string bytes;
  std::size_t size = 0;
  // One byte more than the file has, so that the read that finds the end needs no further memory.
  bytes.resize(static_cast<std::size_t>(status.st_size) + 1);
  while (true) {
    const ssize_t got = ::read(file.number, bytes.data() + size, bytes.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error(fmt::format("{}: reading failed: {}", path.string(), reason(errno)));
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
    if (size == bytes.size()) bytes.resize(size + chunk_bytes);
  }
  bytes.resize(size);
  return bytes;
}

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(path) {
  if (!path.has_filename()) throw Error(fmt::format("'{}': cannot be written: not the name of a file", path.string()));
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    aside_ = folder_of(path) / fmt::format("{}{}-{}{}", unfinished_prefix(path), static_cast<long>(::getpid()), attempt,
                                           unfinished_ending);
    descriptor_ = ::open(aside_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) {
      const int error_number = errno;
      aside_.clear();
      fail("cannot be written", error_number);
    }
  }
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!aside_.empty()) ::unlink(aside_.c_str());
}

void AtomicFile::fail(std::string_view action, int error_number) const {
  throw Error(fmt::format("{}: {}: {}", path_.string(), action, reason(error_number)));
}

void AtomicFile::write(std::string_view bytes) {
  pending_.append(bytes);
  if (pending_.size() >= chunk_bytes) flush();
}

void AtomicFile::flush() {
  std::string_view rest = pending_;
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("writing failed", errno);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  pending_.clear();
}

void AtomicFile::close() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0) fail("writing failed", errno);  // network file systems report a full disk here
}

void AtomicFile::commit() {
  flush();
  if (::fsync(descriptor_) != 0) fail("writing failed", errno);
  close();
  const Descriptor folder(open_folder(folder_of(path_)));
  if (folder.number < 0) fail("its folder cannot be opened", errno);
  if (::rename(aside_.c_str(), path_.c_str()) != 0) fail("cannot be written", errno);
  aside_.clear();
  // The new name is safe only once the folder is on the disk as well.
  if (::fsync(folder.number) != 0 && errno != EINVAL)
    throw SyncError(fmt::format("{}: its folder cannot be synced: {}", path_.string(), reason(errno)));
}

void write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

void rename_and_sync(const std::filesystem::path& from, const std::filesystem::path& to) {
  const Descriptor folder(open_folder(folder_of(to)));
  if (folder.number < 0 || ::rename(from.c_str(), to.c_str()) != 0)
    throw Error(fmt::format("{}: cannot be renamed to {}: {}", from.string(), to.string(), reason(errno)));
  if (::fsync(folder.number) != 0 && errno != EINVAL)
    throw SyncError(fmt::format("{}: its folder cannot be synced: {}", to.string(), reason(errno)));
}

void remove_unfinished(const std::filesystem::path& path) {
  const std::string prefix = unfinished_prefix(path);
  const auto is_unfinished = [&prefix](const std::string& name) {
    if (!name.starts_with(prefix) || !name.ends_with(unfinished_ending)) return false;
    if (name.size() <= prefix.size() + unfinished_ending.size()) return false;
    const std::string who = name.substr(prefix.size(), name.size() - prefix.size() - unfinished_ending.size());
    return who.find_first_not_of("0123456789-") == std::string::npos;
  };
  std::vector<std::filesystem::path> unfinished;
  std::error_code ignored;
  for (std::filesystem::directory_iterator entry(folder_of(path), ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    if (is_unfinished(entry->path().filename().string())) unfinished.push_back(entry->path());
  }
  for (const std::filesystem::path& file : unfinished) std::filesystem::remove(file, ignored);
}

void create_folders(const std::filesystem::path& path) {
  const auto fail = [&path](int error_number) {
    throw Error(fmt::format("cannot create the folder {}: {}", path.string(), reason(error_number)));
  };
  std::filesystem::path made;
  for (const std::filesystem::path& part : path.lexically_normal()) {
    if (part.empty()) continue;  // behind a last slash
    const std::filesystem::path above = made.empty() ? std::filesystem::path(".") : made;
    made /= part;
    if (::mkdir(made.c_str(), 0777) != 0) {
      const int error_number = errno;
      std::error_code ignored;
      if (std::filesystem::is_directory(made, ignored)) continue;
      fail(error_number);
    }
    const Descriptor folder(open_folder(above));
    if (folder.number < 0 || (::fsync(folder.number) != 0 && errno != EINVAL)) fail(errno);
  }
}

}  // namespace vantage
