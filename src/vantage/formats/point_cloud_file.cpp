#include "vantage/formats/point_cloud_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/pcd.hpp"
#include "vantage/formats/ply.hpp"

namespace vantage {
namespace {

constexpr double shortest_normal = 1e-6;

/// The columns of a table of points; the normals' are null where there are none.
struct Columns {
  std::array<const std::vector<double>*, 3> point{};
  std::array<const std::vector<double>*, 3> normal{};

  [[nodiscard]] std::size_t rows() const { return point[0]->size(); }
};

Vec3 at(const std::array<const std::vector<double>*, 3>& columns, std::size_t row) {
  return {(*columns[0])[row], (*columns[1])[row], (*columns[2])[row]};
}

Vec3 unit_or_zero(const Vec3& normal) {
  const double length = normal.norm();
  return std::isfinite(length) && length > shortest_normal ? Vec3(normal / length) : Vec3(Vec3::Zero());
}

/// Adds the finite points; the result has the new index of each row, -1 for those left out.
std::vector<std::int32_t> add_points(const Columns& columns, PointCloud& cloud) {
  const bool has_normals =
      std::all_of(columns.normal.begin(), columns.normal.end(), [](auto* c) { return c != nullptr; });
  std::vector<std::int32_t> new_index(columns.rows(), -1);
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    const Vec3 point = at(columns.point, row);
    if (!point.allFinite()) continue;
    new_index[row] = static_cast<std::int32_t>(cloud.size());
    cloud.add(point, has_normals ? unit_or_zero(at(columns.normal, row)) : Vec3(Vec3::Zero()));
  }
  return new_index;
}

/// `num_cols 512` among the lines of a PLY header.
std::optional<std::uint64_t> info_number(const Ply& ply, std::string_view key) {
  for (const std::string& line : ply.info) {
    if (line.size() > key.size() && line.compare(0, key.size(), key) == 0 && line[key.size()] == ' ') {
      return to_unsigned(trimmed(std::string_view(line).substr(key.size())));
    }
  }
  return std::nullopt;
}

void read_range_grid(const Ply& ply, const PlyElement& cells, const std::vector<std::int32_t>& new_index,
                     const std::string& name, CloudFile& result) {
  const auto columns = info_number(ply, "num_cols");
  const auto rows = info_number(ply, "num_rows");
  constexpr std::uint64_t most = 1U << 24U;
  require(
      columns && rows && *columns > 0 && *rows > 0 && *columns < most && *rows < most && *columns * *rows == cells.rows,
      name, ": the element 'range_grid' has ", cells.rows,
      " cells; must be num_cols times num_rows of the lines 'obj_info'");
  const PlyColumn* list = cells.find("vertex_indices");
  require(list != nullptr && list->is_list, name, ": element 'range_grid' has no list 'vertex_indices'");
  result.grid = {static_cast<int>(*columns), static_cast<int>(*rows)};
  result.point_of_cell.assign(cells.rows, -1);
  std::size_t begin = 0;
  for (std::size_t cell = 0; cell < cells.rows; ++cell) {
    const std::size_t end = list->ends[cell];
    require(end - begin <= 1, name, ": cell ", cell, " of 'range_grid' has ", end - begin, " vertices, must be 0 or 1");
    if (end > begin) {
      const double vertex = list->values[begin];
      require(vertex >= 0 && vertex < static_cast<double>(new_index.size()) && vertex == std::floor(vertex), name,
              ": cell ", cell, " of 'range_grid' has the vertex ", vertex, ": there are ", new_index.size());
      result.point_of_cell[cell] = new_index[static_cast<std::size_t>(vertex)];
    }
    begin = end;
  }
}

CloudFile parse_ply_cloud(std::string_view bytes, const std::string& name, std::size_t most_values) {
  const Ply ply = parse_ply(bytes, name, most_values);
  const PlyElement* vertices = ply.find("vertex");
  require(vertices != nullptr && vertices->rows > 0, name, ": has no points");
  const auto column = [&](std::string_view property) {
    const PlyColumn* found = vertices->find(property);
    return found == nullptr || found->is_list ? nullptr : &found->values;
  };
  CloudFile result;
  const auto new_index =
      add_points({{&scalar_column(*vertices, "x", name).values, &scalar_column(*vertices, "y", name).values,
                   &scalar_column(*vertices, "z", name).values},
                  {column("nx"), column("ny"), column("nz")}},
                 result.cloud);
  if (const PlyElement* cells = ply.find("range_grid")) read_range_grid(ply, *cells, new_index, name, result);
  return result;
}

CloudFile parse_pcd_cloud(std::string_view bytes, const std::string& name, std::size_t most_values) {
  const Pcd pcd = parse_pcd(bytes, name, most_values);
  Columns columns{{pcd.find("x"), pcd.find("y"), pcd.find("z")},
                  {pcd.find("normal_x"), pcd.find("normal_y"), pcd.find("normal_z")}};
  require(columns.point[0] != nullptr && columns.point[1] != nullptr && columns.point[2] != nullptr, name,
          ": FIELDS must have x, y and z");
  CloudFile result;
  result.cloud_from_sensor = pcd.viewpoint;
  auto new_index = add_points(columns, result.cloud);
  if (pcd.size.rows > 1) {
    result.grid = pcd.size;
    result.point_of_cell = std::move(new_index);
  }
  return result;
}

CloudFile parse_text_cloud(std::string_view bytes, bool with_normals, const std::string& name,
                           std::size_t most_values) {
  TextReader text(bytes, name);
  CloudFile result;
  while (text.next_line_with_words()) {
    if (trimmed(text.rest_of_line())[0] == '#') continue;
    Vec3 point;
    for (double& coordinate : point) coordinate = text.number("a coordinate");
    Vec3 normal = Vec3::Zero();
    if (with_normals) {
      for (double& coordinate : normal) coordinate = text.number("a coordinate of the normal");
    }
    if (point.allFinite()) result.cloud.add(point, unit_or_zero(normal));
    require(result.cloud.size() <= most_values / 3, name, ": has more than ", most_values / 3, " points");
  }
  return result;
}

}  // namespace

CloudFormat cloud_format(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".ply") return CloudFormat::ply;
  if (ending == ".pcd") return CloudFormat::pcd;
  if (ending == ".xyz") return CloudFormat::xyz;
  if (ending == ".xyzn") return CloudFormat::xyzn;
  throw InputError(fmt::format("{}: a point cloud must be a .ply, .pcd, .xyz or .xyzn file", path.string()));
}

CloudFile parse_cloud(std::string_view bytes, CloudFormat format, const std::string& name, std::size_t most_values) {
  if (bytes.empty()) throw InputError(name + ": is empty");
  CloudFile result;
  switch (format) {
    case CloudFormat::ply:
      result = parse_ply_cloud(bytes, name, most_values);
      break;
    case CloudFormat::pcd:
      result = parse_pcd_cloud(bytes, name, most_values);
      break;
    case CloudFormat::xyz:
    case CloudFormat::xyzn:
      result = parse_text_cloud(bytes, format == CloudFormat::xyzn, name, most_values);
      break;
  }
  require(result.cloud.size() > 0, name, ": has no point with finite coordinates");
  return result;
}

CloudFile read_cloud(const std::filesystem::path& path) {
  const CloudFormat format = cloud_format(path);
  return parse_cloud(read_file(path), format, path.string());
}

void write_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud) {
  require(cloud.points.size() == cloud.normals.size(), path.string(), ": a cloud of ", cloud.points.size(),
          " points has ", cloud.normals.size(), " normals; must be as many");
  AtomicFile file(path);
  const Coordinates coordinates = coordinates_for(cloud.points);
  file.write(ply_header(cloud.size(), coordinates, {"nx", "ny", "nz"}));
  std::string row;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    row.clear();
    append_point(row, cloud.points[i], coordinates);
    for (const double coordinate : cloud.normals[i]) append_float32(row, coordinate);
    file.write(row);
  }
  file.commit();
}

}  // namespace vantage
