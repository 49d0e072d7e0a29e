#pragma once

#include <array>
#include <cstdint>

#include "vantage/map/lattice_projection.hpp"

namespace vantage {

/// Where the pixels of a view see each voxel of a block of 4x4x4 that lies in front of the camera. The voxels share the
/// projections of their corners.
class BlockPixels {
 public:
  static constexpr int side = 4;

  /// The block from local index `low`; `size` is that of the enclosure, `block` the block's footprint.
  BlockPixels(const LatticeProjection& projection, const Index3& low, const Index3& size,
              const LatticeProjection::Footprint& block);

  /// Pixels whose rays may pass the voxel at `offset` from `low`; no others do.
  [[nodiscard]] PixelRect rect(const Index3& offset) const {
    const std::size_t i = place(offset);
    return projection_.pixels_within(columns_.least[i], columns_.most[i], rows_.least[i], rows_.most[i], margin_);
  }
  /// The pixel nearest to the centre of the voxel at `offset`, where the block is dense.
  struct Pixel {
    int column, row;
  };
  [[nodiscard]] Pixel nearest_to_center(const Index3& offset) const {
    const std::size_t i = place(offset);
    return {center_columns_[i], center_rows_[i]};
  }

 private:
  static constexpr int corners_per_side = side + 1;
  static constexpr std::size_t corners = corners_per_side * corners_per_side * corners_per_side;
  using Values = std::array<double, corners>;
  struct Ranges {
    Values least, most;
  };

  /// Voxels lie at the place of their first corner.
  [[nodiscard]] static std::size_t place(const Index3& offset) {
    return static_cast<std::size_t>((offset.z() * corners_per_side + offset.y()) * corners_per_side + offset.x());
  }
  static void extend_to_voxels(Ranges& ranges);

  const LatticeProjection& projection_;
  double margin_;
  Ranges columns_, rows_;
  std::array<std::int32_t, corners> center_columns_, center_rows_;
};

}  // namespace vantage
