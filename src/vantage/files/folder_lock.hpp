#pragma once

#include <filesystem>
#include <string>

namespace vantage {

/// Keeps other processes from working in the same folder; ends with the object or the process, however that ends.
class FolderLock {
 public:
  /// Throws Error where another process holds it, naming the folder and `what_then`, or the folder cannot be written
  /// to.
  FolderLock(const std::filesystem::path& folder, const std::string& what_then);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace vantage
