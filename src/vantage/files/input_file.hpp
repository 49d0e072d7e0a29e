#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace vantage {

/// A regular file of which parts are read where they are needed, for files that are too large for memory.
class InputFile {
 public:
  /// Throws InputError naming the path where it is missing, no regular file or not readable.
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// The bytes from `offset` on, `count` of them or as many as there are. Throws Error where the disk fails.
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t count) const;

 private:
  std::string name_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace vantage
