#pragma once

#include <filesystem>
#include <string>

namespace vantage {

/// The text without the folders of this machine, for answers to other machines: of every absolute path the last name
/// is left, of files below `folder` the path from its name on (`mug/session/000001.scan`).
[[nodiscard]] std::string without_folders(std::string text, const std::filesystem::path& folder = {});

}  // namespace vantage
