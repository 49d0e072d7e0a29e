#pragma once

#include <cstddef>
#include <cstdint>

// What the vectorised path takes and gives. The kernels are compiled once per instruction set, so that nothing here may
// pull in inline functions: the linker could keep a copy that older processors cannot run.
namespace vantage {

/// A view for the vectorised path. Voxel indices count from `middle`, pixels from (middle_column, middle_row), so that
/// the numbers stay small and their rounding too. Offsets and depths are in voxels.
struct BatchView {
  std::int32_t middle[3];           // local voxel index
  float offset[3];                  // of the middle voxel's centre from the camera
  double pixel_of_middle[3];        // (column*depth, row*depth, depth) of that centre
  double pixel_per_voxel[3][3];     // [column*depth, row*depth, depth][axis]
  float per_column[3], per_row[3];  // change of a ray's direction from column to column, row to row
  std::int32_t middle_column, middle_row;
  std::int32_t columns, rows;
  std::int32_t cell[3];                 // the camera's voxel
  float half_depth;                     // of a voxel
  float nearest_depth, farthest_depth;  // voxels wholly between them are not cut by the depth limits
  float before_depth, beyond_depth;     // voxels wholly before or beyond them are never seen
  float row_error;                      // of a projected centre, in rows
  float line_error;                     // of a nearly level half-plane's value at a pixel of the voxel's window
  float column_error;                   // of every border, in columns, and
  float column_error_of_steepness;      // that of the border of column*c + row*r + k > 0, times |column|
  std::uint8_t* strips;                 // Coverage::first_strip()
  std::int32_t stride;                  // bytes from strip to strip
  /// Takes the voxels that need double precision; returns whether they are visible.
  bool (*splat_one)(const void* context, std::uint32_t packed_voxel);
  const void* context;
};

/// The two conditions that a pair of axes (a, b) puts on a ray ("enters a before it leaves b" and the other way round)
/// as half-planes column*c + row*r + constant > 0 around a voxel's projected centre. Their coefficients are linear in
/// the voxel's index: column = column_of_middle[i] +- (column_per_voxel[0]*index[a] + column_per_voxel[1]*index[b]).
struct BatchPair {
  float column_of_middle[2], column_per_voxel[2];
  float row_of_middle[2], row_per_voxel[2];
};

/// Voxels on one side of the camera (Region), for the vectorised path.
struct BatchRegion {
  float side[3];                // +1 or -1
  BatchPair pair[3];            // pair c: axes (c+1)%3 and (c+2)%3
  std::int32_t min[3], max[3];  // local voxel indices
};

/// Splats packed voxels in their order; writes the visible ones to `visible`, which has room for all, and returns how
/// many they are.
using SplatBatch = std::size_t (*)(const BatchView& view, const BatchRegion& region, const std::uint32_t* voxels,
                                   std::size_t count, std::uint32_t* visible);

/// Copies the packed voxels that lie in the region, in their order; `inside` has room for 16 more than there are.
using SelectInside = std::size_t (*)(const BatchRegion& region, const std::uint32_t* voxels, std::size_t count,
                                     std::uint32_t* inside);

/// SurfaceNormals for the vectorised path.
struct NormalTable {
  const std::uint64_t* occupied;      // bit plane
  const std::uint32_t* rank_of_word;  // occupied voxels before each word
  const double* normals;              // x, y, z of each
  std::size_t rows_per_layer, words_per_row;
};

/// Visible voxels by kind (PackedVoxel::Kind), and the sum of Visibility.
struct BatchTally {
  std::int64_t kinds[4];
  std::int64_t cosine_sum;
};

/// Counts voxels; occupied ones whose normal's cosine is below `min_cosine` count in nothing.
using TallyVoxels = BatchTally (*)(const NormalTable& table, const double (&axis)[3], double min_cosine,
                                   const std::uint32_t* voxels, std::size_t count);

struct SplatKernels {
  SplatBatch splat;
  SelectInside select;
  TallyVoxels tally;
};

[[nodiscard]] SplatKernels splat_kernels_portable();
[[nodiscard]] SplatKernels splat_kernels_avx2();
[[nodiscard]] SplatKernels splat_kernels_avx512();

}  // namespace vantage
