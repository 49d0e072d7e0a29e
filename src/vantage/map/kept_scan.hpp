#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "vantage/map/scan.hpp"

namespace vantage {

/// A scan that is kept to be used again, in less memory: stretches of equal depths, which are what a sensor did not
/// meet, are stored once, and the normals of an image are computed again.
class KeptScan {
 public:
  explicit KeptScan(const Scan& scan);

  /// The scan, to the last bit.
  [[nodiscard]] Scan scan() const;
  /// Of its measurements, in memory.
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// `count` pixels: each with a depth of its own, or all with the same.
  struct Stretch {
    std::uint32_t count = 0;
    bool is_equal = false;
  };
  struct PackedImage {
    RangeCamera camera;
    std::vector<Stretch> stretches;
    std::vector<float> depth;
  };
  [[nodiscard]] static PackedImage packed(const RangeImage& image);
  [[nodiscard]] static RangeImage unpacked(const PackedImage& image);

  std::variant<PackedImage, PointScan> scan_;
};

}  // namespace vantage
