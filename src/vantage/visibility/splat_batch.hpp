#pragma once

#include <cstddef>
#include <cstdint>

// What the vectorised path takes and gives. The kernels are compiled once per instruction set, so that nothing here may
// pull in inline functions: the linker could keep a copy that older processors cannot run.
namespace vantage {

/// A view for the vectorised path, in single precision. Offsets are in voxels from the camera; voxel indices count from
/// `middle`, pixels from (middle_column, middle_row), so that the numbers stay small and their rounding too.
struct BatchView {
  float middle[3];                  // local voxel index
  float offset[3];                  // of the centre of the middle voxel
  float pixel_of_offset[3];         // (column*depth, row*depth, depth) of that centre
  float pixel_per_voxel[3][3];      // [column*depth, row*depth, depth][axis]
  float per_column[3], per_row[3];  // change of a ray's direction from column to column, row to row
  int middle_column, middle_row;
  int columns, rows;
  float half_depth;                     // of a voxel
  float nearest_depth, farthest_depth;  // voxels wholly between them are not cut by the depth limits
  float before_depth, beyond_depth;     // voxels wholly before or beyond them are never seen
  float column_error, row_error;        // of a projected centre, in pixels
  float line_error;                     // of a half-plane's value at a pixel of the voxel's window
  float column_error_of_steepness;      // a line column*c + row*r + k > 0 errs by this over |column|, in columns
  std::uint64_t* tiles;                 // Coverage::first_tile()
  std::ptrdiff_t stride;
  /// Takes the voxels that need double precision; returns whether they are visible.
  bool (*splat_one)(const void* context, std::uint32_t packed_voxel);
  const void* context;
};

/// The two conditions that a pair of axes (a, b) puts on a ray, as half-planes around the voxel's projected centre:
/// (P + column[0]) c + (Q + row[0]) r + .. > 0 and (column[1] - P) c + (row[1] - Q) r + .. > 0.
struct BatchPair {
  float half[2];  // 1/2, or -1/2 where the silhouette's edge lies on the near face because the camera is in the slab
  float column[2], row[2];
};

/// Voxels on one side of the camera (Region), for the vectorised path.
struct BatchRegion {
  float side[3];      // +1 or -1; +1 in the camera's slab
  BatchPair pair[3];  // pair c: axes (c+1)%3 and (c+2)%3
};

/// Splats packed voxels in their order; writes the visible ones to `visible`, which has room for all, and returns how
/// many they are.
using SplatBatch = std::size_t (*)(const BatchView& view, const BatchRegion& region, const std::uint32_t* voxels,
                                   std::size_t count, std::uint32_t* visible);

std::size_t splat_batch_portable(const BatchView&, const BatchRegion&, const std::uint32_t*, std::size_t,
                                 std::uint32_t*);
std::size_t splat_batch_avx2(const BatchView&, const BatchRegion&, const std::uint32_t*, std::size_t, std::uint32_t*);
std::size_t splat_batch_avx512(const BatchView&, const BatchRegion&, const std::uint32_t*, std::size_t, std::uint32_t*);

}  // namespace vantage
