#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "vantage/map/scan.hpp"
#include "vantage/model/scratch_file.hpp"

namespace vantage {

/// A scan that is kept to be used again, outside of memory: stretches of equal depths, which are what a sensor did not
/// meet, are stored once, and the normals of an image are computed again.
class KeptScan {
 public:
  KeptScan(const Scan& scan, std::shared_ptr<ScratchFile> file);

  /// The scan, to the last bit.
  [[nodiscard]] Scan scan() const;
  /// Of its measurements, in the file.
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// `count` pixels: each with a depth of its own, or all with the same.
  struct Stretch {
    std::uint32_t count = 0;
    std::uint32_t is_equal = 0;
  };
  struct PackedImage {
    RangeCamera camera;
    std::vector<Stretch> stretches;
    std::vector<float> depth;
  };
  [[nodiscard]] static PackedImage packed(const RangeImage& image);
  [[nodiscard]] static RangeImage unpacked(const PackedImage& image);

  std::shared_ptr<ScratchFile> file_;
  std::optional<RangeCamera> camera_;       // of an image: pieces are its stretches and depths
  std::vector<ScratchFile::Piece> pieces_;  // of a cloud: points, normals, origins
};

}  // namespace vantage
