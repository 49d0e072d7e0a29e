#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vantage/recordings/frame.hpp"

namespace vantage {

/// A recording as a stream of frames: a folder of images, a data set's layout, a bag. Opening one finds the frames,
/// their times and poses; pixels are decoded when a frame is read, one at a time, so that memory does not grow with
/// their number. Frames come in the order in which they were taken.
class FrameSource {
 public:
  FrameSource() = default;
  virtual ~FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  /// The frames that can be read.
  [[nodiscard]] virtual const std::vector<FrameInfo>& frames() const = 0;
  /// Decodes one frame; `index` is its place in frames(). Fastest in their order. Throws InputError naming the file,
  /// and the frame, where it is damaged. May be called from several threads.
  [[nodiscard]] virtual Frame read(std::size_t index) = 0;
  /// One line: what was recognised, with how many frames, and where poses and intrinsics come from.
  [[nodiscard]] virtual std::string description() const = 0;
  /// Frames that were left out and parts that could not be read, a line each with the reason.
  [[nodiscard]] virtual std::vector<std::string> left_out() const = 0;

  /// The next frame in order, each decoded once; nothing after the last one.
  [[nodiscard]] std::optional<Frame> next() {
    if (next_ >= frames().size()) return std::nullopt;
    return read(next_++);
  }

 private:
  std::size_t next_ = 0;
};

}  // namespace vantage
