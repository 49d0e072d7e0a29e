#include "vantage/recordings/pixel_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/recordings/pose_source.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// The first of NAME + ENDING that is in the folder.
std::optional<fs::path> image_of(const fs::path& folder, const std::vector<std::string>& names,
                                 const std::vector<std::string>& endings) {
  for (const std::string& ending : endings) {
    for (const std::string& name : names) {
      if (fs::is_regular_file(folder / (name + ending))) return folder / (name + ending);
    }
  }
  return std::nullopt;
}

std::optional<fs::path> mask_file(const fs::path& folder, const std::vector<std::string>& names,
                                  const ScanFolderOptions& options) {
  if (options.masks.empty()) return image_of(folder, names, {".mask.png"});
  const fs::path place = below(folder, options.masks);
  const auto mask = image_of(place, names, {".mask.png", ".png"});
  require(mask.has_value(), (place / (names.front() + ".mask.png")).string(),
          ": there is no such file; with --masks each frame must have one");
  return mask;
}

fs::path confidence_file(const fs::path& folder, const std::vector<std::string>& names,
                         const ConfidenceChoice& choice) {
  const fs::path place = below(folder, choice.folder);
  const auto image = image_of(place, names, {".confidence.png", ".png"});
  require(image.has_value(), (place / (names.front() + ".png")).string(),
          ": there is no such file; with --confidence each frame must have one");
  return *image;
}

Mask confident_pixels(const fs::path& image, double least, Resolution resolution) {
  Mask counts;
  for (const std::uint16_t value : decode_png_grey(read_file(image), resolution, image.string()))
    counts.push_back(value >= least ? 1 : 0);
  return counts;
}

}  // namespace

ConfidenceChoice confidence_choice(const std::string& text) {
  const std::size_t comma = text.rfind(',');
  double least = std::numeric_limits<double>::quiet_NaN();
  if (comma != std::string::npos) least = to_double(trimmed(text.substr(comma + 1))).value_or(least);
  require(comma != 0 && std::isfinite(least), "confidence = ", in_quotes(text),
          ": must be FOLDER,LEAST, like confidence,2");
  return {text.substr(0, comma), least};
}

void require_pixel_choices(const fs::path& folder, const std::vector<std::string>& names,
                           const ScanFolderOptions& options) {
  (void)mask_file(folder, names, options);
  if (!options.confidence.empty()) (void)confidence_file(folder, names, confidence_choice(options.confidence));
}

std::optional<Mask> counted_pixels(const fs::path& folder, const std::vector<std::string>& names,
                                   const ScanFolderOptions& options, Resolution resolution) {
  std::optional<Mask> counts;
  if (const auto mask = mask_file(folder, names, options))
    counts = decode_png_mask(read_file(*mask), resolution, mask->string());
  if (options.confidence.empty()) return counts;
  const ConfidenceChoice choice = confidence_choice(options.confidence);
  Mask confident = confident_pixels(confidence_file(folder, names, choice), choice.least, resolution);
  if (counts)
    std::transform(confident.begin(), confident.end(), counts->begin(), confident.begin(),
                   [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a & b); });
  return confident;
}

}  // namespace vantage
