#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/recordings/scan_folder.hpp"

namespace vantage {

/// The pixels of a frame that count, by its mask and by its confidences; nothing where it has neither and needs
/// neither. The mask is NAME.mask.png beside the frames, or in the folder of the options, where NAME.png will do, too;
/// the confidence image is NAME.confidence.png or NAME.png. `names` are those that the frame has. Throws InputError
/// naming the file that is missing or of another size.
[[nodiscard]] std::optional<Mask> counted_pixels(const std::filesystem::path& folder,
                                                 const std::vector<std::string>& names,
                                                 const ScanFolderOptions& options, Resolution resolution);

/// Throws InputError where a mask or confidence image that the options ask for is not there.
void require_pixel_choices(const std::filesystem::path& folder, const std::vector<std::string>& names,
                           const ScanFolderOptions& options);

/// A folder of confidence images, and the least value that counts.
struct ConfidenceChoice {
  std::string folder;
  double least = 0;
};
/// What FOLDER,LEAST says; throws InputError where it says something else.
[[nodiscard]] ConfidenceChoice confidence_choice(const std::string& text);

}  // namespace vantage
