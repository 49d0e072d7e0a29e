#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vantage/map/grid.hpp"

namespace vantage {

/// A NRRD file with one byte per voxel, x fastest.
struct Nrrd {
  Grid grid;                          // of the whole scene
  IndexBox stored;                    // whose voxels the file holds; the others are empty
  std::optional<IndexBox> enclosure;  // the key of the same name
  std::string_view voxels;            // points into the bytes that were parsed
};

/// Throws InputError with `name` and the line where the header is not that of a raw, attached, three-dimensional file
/// of uint8 voxels that are cubes, or its sizes do not fit the data.
[[nodiscard]] Nrrd parse_nrrd(std::string_view bytes, const std::string& name);

/// The header up to the first voxel. Its origin is chosen so that parse_nrrd() gives back the same grid to the last bit
/// wherever a double allows it. A file that holds only the box `stored` of the grid has the voxels of that box
/// for its own, by which its origin and enclosure count, and a key `scene:=SIZES FIRST MIN` with the grid's size, the
/// index of the file's first voxel in it, and its lower corner.
[[nodiscard]] std::string nrrd_header(const Grid& grid, const IndexBox& enclosure, const IndexBox& stored);
[[nodiscard]] inline std::string nrrd_header(const Grid& grid, const IndexBox& enclosure) {
  return nrrd_header(grid, enclosure, grid.all());
}

}  // namespace vantage
