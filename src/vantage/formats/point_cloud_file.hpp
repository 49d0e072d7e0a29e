#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/point_cloud.hpp"
#include "vantage/sensor/range_camera.hpp"

namespace vantage {

enum class CloudFormat { ply, pcd, xyz, xyzn };

/// The format that the ending of the name stands for (.ply, .pcd, .xyz, .xyzn, in any case); throws InputError for
/// others.
[[nodiscard]] CloudFormat cloud_format(const std::filesystem::path& path);

/// The measured points of one cloud file.
struct CloudFile {
  /// In the file's unit and frame. Points that are not finite (cells without a measurement) are left out; normals have
  /// length 1, or 0 where the file has none or a meaningless one.
  PointCloud cloud;
  /// Organised clouds only, 0x0 otherwise: `point_of_cell` has the point of each cell, row by row, -1 where there is
  /// none.
  Resolution grid{0, 0};
  std::vector<std::int32_t> point_of_cell;
  /// Where the sensor was, in the frame of the points: the viewpoint of a PCD file, else the identity.
  Pose cloud_from_sensor = Pose::Identity();
};

/// Reads PLY (ASCII or binary; with the element `range_grid` of the Stanford scans it is organised), PCD (ascii, binary
/// or binary_compressed) or text with `x y z` (.xyz, further columns are ignored) or `x y z nx ny nz` (.xyzn) per line.
/// Throws InputError naming the file and the place: empty, cut off, of another format, no number, no point at all.
[[nodiscard]] CloudFile read_cloud(const std::filesystem::path& path);
/// The same from memory; `name` is used in errors. Throws InputError where it has more than `most_values` numbers,
/// those of fields that are not used among them; compressed files are asked before memory is taken for them.
[[nodiscard]] CloudFile parse_cloud(std::string_view bytes, CloudFormat format, const std::string& name,
                                    std::size_t most_values = std::numeric_limits<std::size_t>::max());

/// PLY, binary little endian, float32 x y z nx ny nz; replaces the file atomically.
void write_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace vantage
