#pragma once

#include <memory>

#include "vantage/recordings/frame_source.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage {

/// The frames of a recording as scans: with the depth limits, units, hand-eye offset and crop box of the options.
/// Frames without a pose are left out. Throws InputError where none has one.
[[nodiscard]] ScanSet scans_of(const std::shared_ptr<FrameSource>& frames, const ScanFolderOptions& options);

}  // namespace vantage
