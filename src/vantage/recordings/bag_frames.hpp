#pragma once

#include <filesystem>
#include <memory>

#include "vantage/recordings/bag_choice.hpp"
#include "vantage/recordings/frame_source.hpp"

namespace vantage {

/// The depth images or clouds of a bag, with poses and intrinsics from its messages. Reads the bag once to find them.
/// Throws InputError naming the file, the topic or the option, and what would be right.
[[nodiscard]] std::unique_ptr<FrameSource> open_bag_frames(const std::filesystem::path& path,
                                                           const BagOptions& options = {});

}  // namespace vantage
