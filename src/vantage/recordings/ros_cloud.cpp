#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>

#include "vantage/core/error.hpp"
#include "vantage/recordings/ros_image.hpp"

namespace vantage {
namespace {

constexpr std::uint8_t float32 = 7, float64 = 8;

/// Where a coordinate is stored in a point.
struct Coordinate {
  std::size_t offset = 0;
  std::size_t bytes = 4;
};

std::optional<Coordinate> coordinate(const RosPointCloud& cloud, std::string_view field, const std::string& name) {
  const auto found = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [&](const RosPointField& each) { return each.name == field; });
  if (found == cloud.fields.end()) return std::nullopt;
  require(found->type == float32 || found->type == float64, name, ": field ", field, " is of type ", int{found->type},
          ", must be 7 (float32) or 8 (float64)");
  const Coordinate place{found->offset, found->type == float64 ? std::size_t{8} : std::size_t{4}};
  require(place.offset + place.bytes <= cloud.point_step, name, ": field ", field, " ends beyond the ",
          cloud.point_step, " bytes of a point");
  return place;
}

using Coordinates = std::array<Coordinate, 3>;

std::optional<Coordinates> coordinates(const RosPointCloud& cloud, const std::array<const char*, 3>& fields,
                                       const std::string& name) {
  Coordinates places;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto place = coordinate(cloud, fields[i], name);
    if (!place) return std::nullopt;
    places[i] = *place;
  }
  return places;
}

double number_at(const char* at, std::size_t bytes, bool is_big_endian) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < bytes; ++k) {
    const std::size_t shift = 8 * (is_big_endian ? bytes - 1 - k : k);
    value |= std::uint64_t{static_cast<unsigned char>(at[k])} << shift;
  }
  if (bytes == 8) return std::bit_cast<double>(value);
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(value)));
}

Vec3 vector_at(const char* point, const Coordinates& places, bool is_big_endian) {
  Vec3 v;
  for (std::size_t i = 0; i < 3; ++i)
    v[static_cast<Eigen::Index>(i)] = number_at(point + places[i].offset, places[i].bytes, is_big_endian);
  return v;
}

Vec3 direction_or_zero(const Vec3& v) {
  const double length = v.norm();
  return length > 0 && length < std::numeric_limits<double>::infinity() ? Vec3(v / length) : Vec3(Vec3::Zero());
}

void check_sizes(const RosPointCloud& cloud, const std::string& name) {
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  require(cloud.height <= 1 || cloud.row_step >= row, name, ": row_step = ", cloud.row_step, " bytes; a row of ",
          cloud.width, " points needs ", row);
  const std::uint64_t least = cloud.height == 0 ? 0 : std::uint64_t{cloud.row_step} * (cloud.height - 1) + row;
  require(cloud.data.size() >= least, name, ": has ", cloud.data.size(), " bytes of points, must have ", least);
  constexpr std::uint32_t most = std::numeric_limits<std::int32_t>::max();
  require(cloud.width <= most && cloud.height <= most && std::uint64_t{cloud.width} * cloud.height <= most, name, ": ",
          cloud.width, "x", cloud.height, " points; must be at most ", most);
}

}  // namespace

CloudFile cloud_of(const RosPointCloud& cloud, const std::string& name) {
  const std::optional<Coordinates> position = coordinates(cloud, {"x", "y", "z"}, name);
  require(position.has_value(), name, ": a cloud without the fields x, y and z");
  const std::optional<Coordinates> normal = coordinates(cloud, {"normal_x", "normal_y", "normal_z"}, name);
  check_sizes(cloud, name);
  CloudFile file;
  const bool is_organised = cloud.height > 1 && cloud.width > 1;
  if (is_organised) file.grid = {static_cast<int>(cloud.width), static_cast<int>(cloud.height)};
  for (std::size_t row = 0; row < cloud.height; ++row) {
    for (std::size_t column = 0; column < cloud.width; ++column) {
      const char* point = cloud.data.data() + row * cloud.row_step + column * cloud.point_step;
      const Vec3 place = vector_at(point, *position, cloud.is_big_endian);
      // Drivers write the origin, or NaN, where nothing was measured.
      const bool is_measured = place.allFinite() && !place.isZero(0);
      if (is_organised) file.point_of_cell.push_back(is_measured ? static_cast<std::int32_t>(file.cloud.size()) : -1);
      if (is_measured)
        file.cloud.add(place,
                       normal ? direction_or_zero(vector_at(point, *normal, cloud.is_big_endian)) : Vec3(Vec3::Zero()));
    }
  }
  require(file.cloud.size() > 0, name, ": a cloud without a point");
  return file;
}

}  // namespace vantage
