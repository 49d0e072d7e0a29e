#pragma once

#include <filesystem>

namespace vantage {

/// Keeps other processes from working in the same folder; ends with the object or the process, however that ends.
class FolderLock {
 public:
  /// Throws Error where another process holds it or the folder cannot be written to.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace vantage
