#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// One property of all rows of a PLY element, for example `x` of `vertex`.
struct PlyColumn {
  std::string name;
  bool is_list = false;
  /// One value per row, or the values of all lists one after the other. Every PLY type fits into a double exactly.
  std::vector<double> values;
  /// Lists only: where in `values` the list of each row ends.
  std::vector<std::size_t> ends;
};

struct PlyElement {
  std::string name;
  std::size_t rows = 0;
  std::vector<PlyColumn> columns;

  /// nullptr where there is no such property.
  [[nodiscard]] const PlyColumn* find(std::string_view column) const;
};

/// The content of a PLY file of any kind: ASCII or binary of either byte order.
struct Ply {
  std::vector<PlyElement> elements;
  /// The lines of the header that start with `obj_info`, without this word.
  std::vector<std::string> info;

  /// nullptr where there is no such element.
  [[nodiscard]] const PlyElement* find(std::string_view element) const;
};

/// Throws InputError naming `name`, the line or row, and what is wrong with it. Memory stays within a small multiple of
/// the input, whatever its header promises.
[[nodiscard]] Ply parse_ply(std::string_view bytes, const std::string& name,
                            std::size_t most_values = std::numeric_limits<std::size_t>::max());

/// A scalar property that must be there, as `name` and element in the error's text.
[[nodiscard]] const PlyColumn& scalar_column(const PlyElement& element, std::string_view column,
                                             const std::string& name);

/// How the coordinates of a file are written: as float32, which every reader takes, or as float64 where float32 would
/// round them to coarse steps because they lie far from the origin.
enum class Coordinates { float32, float64 };
/// float32 where it keeps coordinates up to `largest` to `resolution`.
[[nodiscard]] Coordinates coordinates_for(double largest, double resolution);
/// float32 where it keeps the points to a 2^18th of their extent.
[[nodiscard]] Coordinates coordinates_for(const std::vector<Vec3>& points);

/// The header of a binary little-endian file with one element `vertex` of x, y, z and further float32 properties.
[[nodiscard]] std::string ply_header(std::size_t vertices, Coordinates coordinates,
                                     const std::vector<std::string>& properties);

/// What a binary little-endian mesh has beside x, y, z and `list uchar int vertex_indices`.
struct PlyMeshHeader {
  std::size_t vertices = 0, triangles = 0;
  Coordinates coordinates = Coordinates::float32;
  std::vector<std::string> vertex_properties = {}, face_properties = {};  // with their types: "float sigma"
};
[[nodiscard]] std::string ply_mesh_header(const PlyMeshHeader& header);

/// Appends x, y, z, little endian.
void append_point(std::string& bytes, const Vec3& point, Coordinates coordinates);

/// Appends the value as four bytes, little endian.
void append_float32(std::string& bytes, double value);
void append_int32(std::string& bytes, std::int32_t value);

}  // namespace vantage
