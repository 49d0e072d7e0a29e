#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/recordings/folder_layout.hpp"

// What the layouts share.
namespace vantage::layout_parts {

namespace fs = std::filesystem;

/// Whether a file has the ending of an image that may hold depths.
[[nodiscard]] bool is_depth_image(const fs::path& path);

/// The files below a folder that fit a pattern with * and ? in any of its parts ("cam*/depth/*.png"), in the order of
/// their numbers. Throws InputError where there are more than a million.
[[nodiscard]] std::vector<fs::path> files_matching(const fs::path& folder, const std::string& pattern);

/// The depth images in a folder, in the order of their numbers; none where the folder is not there.
[[nodiscard]] std::vector<fs::path> depth_images_in(const fs::path& folder);

/// Frames of these images, named by the files without what says that they are depths.
[[nodiscard]] std::vector<LayoutFrame> frames_of(const std::vector<fs::path>& images);

/// The first of these files that is below the folder; nothing where none is.
[[nodiscard]] std::optional<fs::path> first_file(const fs::path& folder, const std::vector<std::string>& names);

/// Gives the frames their poses from a file of many, or from a folder of pose files. Says in the layout what was
/// matched.
void take_poses(FolderLayout& layout, const fs::path& source, const ScanFolderOptions& options);

/// The layouts, each for a folder that looks like one. `numbered` takes any folder with a subfolder `depth` or with
/// files whose names say that they are depths.
[[nodiscard]] std::optional<FolderLayout> tum(const fs::path& folder, const ScanFolderOptions& options);
[[nodiscard]] std::optional<FolderLayout> icl_nuim(const fs::path& folder, const ScanFolderOptions& options);
[[nodiscard]] std::optional<FolderLayout> bop(const fs::path& folder, const ScanFolderOptions& options);
[[nodiscard]] std::optional<FolderLayout> nerf(const fs::path& folder, const ScanFolderOptions& options);
[[nodiscard]] std::optional<FolderLayout> colmap(const fs::path& folder, const ScanFolderOptions& options);
[[nodiscard]] std::optional<FolderLayout> numbered(const fs::path& folder, const ScanFolderOptions& options);

}  // namespace vantage::layout_parts
