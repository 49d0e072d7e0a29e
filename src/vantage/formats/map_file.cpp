#include "vantage/formats/map_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/nrrd.hpp"
#include "vantage/formats/ply.hpp"

namespace vantage {
namespace {

constexpr double centre_tolerance = 0.05;  // voxel lengths; we write them to a thousandth
constexpr double unit_tolerance = 1e-3;
constexpr std::int64_t most_whole_voxels = std::int64_t{1} << 27;  // of a scene that is written whole

std::filesystem::path surface_path(const std::filesystem::path& path) {
  require(path.extension() == ".nrrd", path.string(), ": the name of a map must end in .nrrd");
  return std::filesystem::path(path).replace_extension(".ply");
}

std::string text_of(const Index3& index) { return fmt::format("({}, {}, {})", index.x(), index.y(), index.z()); }

void write_labels(const VoxelMap& map, const std::filesystem::path& path) {
  const Grid& grid = map.grid();
  const IndexBox& enclosure = map.enclosure();
  AtomicFile file(path);
  const IndexBox stored = grid.size.cast<std::int64_t>().prod() > most_whole_voxels ? enclosure : grid.all();
  file.write(nrrd_header(grid, enclosure, stored));
  const std::string outside(static_cast<std::size_t>(stored.size().x()), static_cast<char>(Label::empty));
  std::string row;
  for (int z = stored.min.z(); z <= stored.max.z(); ++z) {
    for (int y = stored.min.y(); y <= stored.max.y(); ++y) {
      row = outside;
      if (enclosure.contains({enclosure.min.x(), y, z})) {
        for (int x = enclosure.min.x(); x <= enclosure.max.x(); ++x) {
          row[static_cast<std::size_t>(x - stored.min.x())] = static_cast<char>(map.label({x, y, z}));
        }
      }
      file.write(row);
    }
  }
  file.commit();
}

void write_surface(const VoxelMap& map, const std::filesystem::path& path) {
  const std::vector<Index3> voxels = map.occupied_voxels();
  AtomicFile file(path);
  const Box3 box = map.grid().box(map.enclosure());
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  constexpr double resolution = 1e-3;  // of a voxel
  const Coordinates coordinates = coordinates_for(largest, resolution * map.grid().length);
  file.write(ply_header(voxels.size(), coordinates, {"nx", "ny", "nz", "quality"}));
  std::string row;
  for (const Index3& voxel : voxels) {
    const SurfaceVoxel& surface = *map.surface(voxel);
    row.clear();
    append_point(row, map.grid().center(voxel), coordinates);
    for (const double coordinate : surface.normal()) append_float32(row, coordinate);
    append_float32(row, surface.quality);
    file.write(row);
  }
  file.commit();
}

void set_labels(const Nrrd& nrrd, const std::string& name, VoxelMap& map) {
  const IndexBox& stored = nrrd.stored;
  std::size_t at = 0;
  Index3 voxel;
  for (voxel.z() = stored.min.z(); voxel.z() <= stored.max.z(); ++voxel.z()) {
    for (voxel.y() = stored.min.y(); voxel.y() <= stored.max.y(); ++voxel.y()) {
      for (voxel.x() = stored.min.x(); voxel.x() <= stored.max.x(); ++voxel.x()) {
        const auto value = static_cast<unsigned char>(nrrd.voxels[at++]);
        if (value >= all_labels.size()) {
          throw InputError(fmt::format("{}: voxel {} has the label {}: labels go from 0 to {}", name, text_of(voxel),
                                       value, all_labels.size() - 1));
        }
        const auto label = static_cast<Label>(value);
        if (map.enclosure().contains(voxel)) {
          if (label != Label::unmarked) map.set_label(voxel, label);
        } else if (label != Label::empty) {
          throw InputError(fmt::format("{}: voxel {} is {}, but lies outside of the enclosure, where all must be empty",
                                       name, text_of(voxel), vantage::name(label)));
        }
      }
    }
  }
}

/// The voxel whose centre this vertex is.
Index3 voxel_of_vertex(const VoxelMap& map, const Vec3& vertex, std::size_t row, const std::string& name) {
  const Grid& grid = map.grid();
  const Box3 scene = grid.box(grid.all());
  if (!vertex.allFinite() || !scene.contains(vertex)) {
    throw InputError(fmt::format("{}: vertex {} at {} lies outside of the scene", name, row, in_brackets(vertex)));
  }
  const Index3 voxel = grid.index_of(vertex);
  const double offset = grid.contains(voxel) ? (vertex - grid.center(voxel)).cwiseAbs().maxCoeff() / grid.length : 1;
  if (!(offset <= centre_tolerance)) {
    throw InputError(fmt::format("{}: vertex {} at {} is not the centre of a voxel (off by {:.3g} voxels)", name, row,
                                 in_brackets(vertex), offset));
  }
  return voxel;
}

void set_surfaces(const NamedBytes& file, VoxelMap& map) {
  const Ply ply = parse_ply(file.bytes, file.name);
  const PlyElement* vertices = ply.find("vertex");
  require(vertices != nullptr, file.name, ": has no element 'vertex'");
  std::array<const std::vector<double>*, 7> columns{};
  constexpr std::array<const char*, 7> names{"x", "y", "z", "nx", "ny", "nz", "quality"};
  for (std::size_t c = 0; c < names.size(); ++c) columns[c] = &scalar_column(*vertices, names[c], file.name).values;
  std::vector<bool> has_surface(static_cast<std::size_t>(map.enclosure().size().cast<std::int64_t>().prod()));
  for (std::size_t row = 0; row < vertices->rows; ++row) {
    const auto value = [&](std::size_t column) { return (*columns[column])[row]; };
    const Index3 voxel = voxel_of_vertex(map, {value(0), value(1), value(2)}, row, file.name);
    if (map.label(voxel) != Label::occupied) {
      throw InputError(fmt::format("{}: vertex {} is in voxel {}, which the labels say is {}, must be occupied",
                                   file.name, row, text_of(voxel), name(map.label(voxel))));
    }
    const Index3 size = map.enclosure().size();
    const Index3 local = voxel - map.enclosure().min;
    const auto flat =
        static_cast<std::size_t>(local.x() + std::int64_t{size.x()} * (local.y() + std::int64_t{size.y()} * local.z()));
    require(!has_surface[flat], file.name, ": voxel ", text_of(voxel), " has two vertices");
    has_surface[flat] = true;
    const Vec3 normal(value(3), value(4), value(5));
    require(normal.isZero(0) || std::abs(normal.norm() - 1) <= unit_tolerance, file.name, ": vertex ", row,
            " has the normal ", in_brackets(normal), ": its length must be 1, or 0 for none");
    const double quality = value(6);
    require(quality >= 0 && quality <= 1, file.name, ": vertex ", row, " has the quality ", quality,
            ": must be within 0 and 1");
    map.set_surface(voxel, {normal, quality});
  }
  const std::int64_t occupied = map.count(Label::occupied);
  require(static_cast<std::int64_t>(vertices->rows) == occupied, file.name, ": has ", vertices->rows, " vertices for ",
          occupied, " occupied voxels; must be one each");
}

}  // namespace

void write_map(const VoxelMap& map, const std::filesystem::path& path) {
  write_surface(map, surface_path(path));
  write_labels(map, path);
}

VoxelMap parse_map(const NamedBytes& labels, const std::optional<NamedBytes>& surface) {
  const Nrrd nrrd = parse_nrrd(labels.bytes, labels.name);
  // The place of the enclosure is checked by the map; say in which file it is wrong.
  VoxelMap map = [&] {
    try {
      return VoxelMap(nrrd.grid, nrrd.enclosure.value_or(nrrd.grid.all()));
    } catch (const InputError& error) {
      throw InputError(labels.name + ": " + error.what());
    }
  }();
  set_labels(nrrd, labels.name, map);
  if (surface) {
    set_surfaces(*surface, map);
  } else {
    require(map.count(Label::occupied) == 0, labels.name, ": ", map.count(Label::occupied),
            " voxels are occupied, but the file with their normals and qualities is missing");
  }
  return map;
}

VoxelMap read_map(const std::filesystem::path& path) {
  const std::filesystem::path beside = surface_path(path);
  const std::string labels = read_file(path);
  std::error_code ignored;
  if (!std::filesystem::exists(beside, ignored)) return parse_map({path.string(), labels}, std::nullopt);
  const std::string surface = read_file(beside);
  return parse_map({path.string(), labels}, NamedBytes{beside.string(), surface});
}

}  // namespace vantage
