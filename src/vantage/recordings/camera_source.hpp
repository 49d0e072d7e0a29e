#pragma once

#include <filesystem>
#include <string>

namespace vantage {

/// The file with the intrinsics of the depth images in a folder: `given`, below the folder or by its own path; else one
/// of the usual names in the folder or, where it has none, in the folder that it lies in. Throws InputError listing the
/// usual names where there is none.
[[nodiscard]] std::filesystem::path intrinsics_file(const std::filesystem::path& folder, const std::string& given);

}  // namespace vantage
