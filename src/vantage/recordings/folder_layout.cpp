#include "vantage/recordings/folder_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/recordings/camera_source.hpp"
#include "vantage/recordings/frame_scans.hpp"
#include "vantage/recordings/layout_parts.hpp"
#include "vantage/recordings/pixel_choice.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// The images of a layout as a stream of frames.
class LayoutFrames : public FrameSource {
 public:
  LayoutFrames(fs::path folder, FolderLayout layout, const ScanFolderOptions& options)
      : folder_(std::move(folder)), layout_(std::move(layout)), options_(options) {
    for (const LayoutFrame& frame : layout_.frames)
      infos_.push_back({frame.name, frame.time_s, frame.world_from_sensor});
  }

  [[nodiscard]] const std::vector<FrameInfo>& frames() const override { return infos_; }

  [[nodiscard]] Frame read(std::size_t index) override {
    const LayoutFrame& file = layout_.frames.at(index);
    const Intrinsics& intrinsics = file.intrinsics ? *file.intrinsics : *layout_.intrinsics;
    Frame frame;
    frame.info = infos_.at(index);
    frame.measured = decode_depth(read_file(file.depth), intrinsics.resolution, file.depth.string());
    frame.metres_per_unit = layout_.metres_per_unit;
    frame.intrinsics = intrinsics;
    const DepthPixels& pixels = std::get<DepthPixels>(frame.measured);
    frame.mask = counted_pixels(folder_, {file.name, file.depth.stem().string()}, options_,
                                std::visit([](const auto& image) { return image.resolution; }, pixels));
    return frame;
  }

  [[nodiscard]] std::string description() const override {
    return fmt::format("{}: {} depth images, {}", layout_.kind, infos_.size(), layout_.poses);
  }

  [[nodiscard]] std::vector<std::string> left_out() const override { return layout_.left_out; }

 private:
  fs::path folder_;
  FolderLayout layout_;
  ScanFolderOptions options_;
  std::vector<FrameInfo> infos_;
};

}  // namespace

std::optional<FolderLayout> recognise_layout(const fs::path& folder, const ScanFolderOptions& options) {
  using namespace layout_parts;
  if (auto layout = colmap(folder, options)) return layout;
  if (!options.depth.empty()) return numbered(folder, options);
  for (const auto& layout_of : {tum, icl_nuim, bop, nerf, numbered}) {
    if (auto layout = layout_of(folder, options)) return layout;
  }
  return std::nullopt;
}

ScanSet scans_of_layout(const fs::path& folder, FolderLayout layout, const ScanFolderOptions& options) {
  const bool all_have = std::all_of(layout.frames.begin(), layout.frames.end(),
                                    [](const LayoutFrame& frame) { return frame.intrinsics.has_value(); });
  if (!options.intrinsics.empty() || (!all_have && !layout.intrinsics)) {
    const fs::path file = intrinsics_file(folder, options.intrinsics);
    layout.intrinsics = read_intrinsics(file);
    for (LayoutFrame& frame : layout.frames) frame.intrinsics.reset();
  }
  return scans_of(std::make_shared<LayoutFrames>(folder, std::move(layout), options), options);
}

}  // namespace vantage
