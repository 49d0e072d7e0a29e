#pragma once

#include <filesystem>

namespace vantage {

/// A fresh folder that only we can read; it is removed with everything in it.
class ScratchFolder {
 public:
  /// Throws Error where none can be made.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace vantage
