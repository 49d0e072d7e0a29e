#include "vantage/map/block_pixels.hpp"

#include <algorithm>

namespace vantage {

BlockPixels::BlockPixels(const LatticeProjection& projection, const Index3& low, const Index3& size,
                         const LatticeProjection::Footprint& block)
    : projection_(projection), margin_(block.margin) {
  Values u, v, w;
  std::size_t corner = 0;
  for (int z = 0; z <= side; ++z) {
    for (int y = 0; y <= side; ++y) {
      for (int x = 0; x <= side; ++x, ++corner) {
        const Index3 at = (low + Index3(x, y, z)).cwiseMin(size);  // where the enclosure ends, the block does
        const LatticeProjection::Homogeneous projected = projection.corner(at.x(), at.y(), at.z());
        u[corner] = projected.u;
        v[corner] = projected.v;
        w[corner] = projected.w;
      }
    }
  }
  for (std::size_t i = 0; i < corners; ++i) {
    const double inverse = 1 / w[i];
    columns_.least[i] = u[i] * inverse;
    rows_.least[i] = v[i] * inverse;
  }
  columns_.most = columns_.least;
  rows_.most = rows_.least;
  extend_to_voxels(columns_);
  extend_to_voxels(rows_);
  if (!projection.is_dense(block)) return;
  // The centre lies halfway between opposite corners, in homogeneous coordinates too.
  const std::size_t opposite = place(Index3::Ones());
  for (std::size_t i = 0; i + opposite < corners; ++i) {
    const double inverse = 1 / (w[i] + w[i + opposite]);
    center_columns_[i] = static_cast<std::int32_t>((u[i] + u[i + opposite]) * inverse + 0.5);
    center_rows_[i] = static_cast<std::int32_t>((v[i] + v[i + opposite]) * inverse + 0.5);
  }
}

/// From values at corners to extremes over the eight corners of each voxel: over pairs along x, then over pairs of
/// those along y, then z. What lands between the voxels is never read.
void BlockPixels::extend_to_voxels(Ranges& ranges) {
  std::size_t reach = 0;
  for (const std::size_t next : {place(Index3::UnitX()), place(Index3::UnitY()), place(Index3::UnitZ())}) {
    reach += next;
    for (std::size_t i = 0; i + reach < corners; ++i) {
      ranges.least[i] = std::min(ranges.least[i], ranges.least[i + next]);
      ranges.most[i] = std::max(ranges.most[i], ranges.most[i + next]);
    }
  }
}

}  // namespace vantage
