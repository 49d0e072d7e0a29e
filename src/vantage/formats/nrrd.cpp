#include "vantage/formats/nrrd.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "vantage/core/error.hpp"
#include "vantage/files/format_version.hpp"
#include "vantage/files/text_reader.hpp"

namespace vantage {
namespace {

constexpr int nrrd_longest_side = 16384;
constexpr std::string_view format_key = "vantage-format";  // maps of 0.1 have none
constexpr int map_format = 1;

/// The numbers of a header field, however they are bracketed: "(0.02,0,0) (0,0.02,0) (0,0,0.02)".
std::vector<double> numbers(const TextReader& text, std::string_view field, std::string_view value, std::size_t count) {
  constexpr std::string_view separators = " \t(),";
  std::vector<double> found;
  while (true) {
    const std::size_t first = value.find_first_not_of(separators);
    if (first == std::string_view::npos) break;
    value.remove_prefix(first);
    const std::string_view word = value.substr(0, value.find_first_of(separators));
    value.remove_prefix(word.size());
    const auto number = to_double(word);
    if (!number || !std::isfinite(*number)) {
      text.fail(fmt::format("{}: {} must be a finite number", field, in_quotes(word)));
    }
    found.push_back(*number);
  }
  if (found.size() != count) text.fail(fmt::format("{}: has {} numbers, must be {}", field, found.size(), count));
  return found;
}

int whole(const TextReader& text, std::string_view field, double value, int least, int most) {
  if (value != std::floor(value) || value < least || value > most) {
    text.fail(fmt::format("{}: {} must be a whole number within {} and {}", field, value, least, most));
  }
  return static_cast<int>(value);
}

struct NrrdHeader {
  bool has_type = false, has_encoding = false;
  std::optional<Index3> sizes;
  std::optional<double> length;
  std::optional<Vec3> origin;
  std::optional<IndexBox> enclosure;
  std::optional<Grid> scene;    // of which the file holds a part; without its length
  std::optional<Index3> first;  // voxel of the file in it
};

double voxel_length(const TextReader& text, std::string_view value) {
  const std::vector<double> n = numbers(text, "space directions", value, 9);
  const Mat3 directions = Eigen::Map<const Mat3>(n.data());
  const double length = directions(0, 0);
  if (!(length > 0) || directions != Mat3(length * Mat3::Identity())) {
    text.fail(
        fmt::format("space directions: {} must be the voxel length on the diagonal and 0 elsewhere", in_quotes(value)));
  }
  return length;
}

void read_field(const TextReader& text, std::string_view field, std::string_view value, NrrdHeader& header) {
  const auto demand = [&](bool holds, std::string_view right) {
    if (!holds) text.fail(fmt::format("{}: {} must be {}", field, in_quotes(value), right));
  };
  if (field == "type") {
    demand(value == "uint8" || value == "uint8_t" || value == "uchar" || value == "unsigned char", "uint8");
    header.has_type = true;
  } else if (field == "dimension" || field == "space dimension") {
    demand(value == "3", "3");
  } else if (field == "encoding") {
    demand(value == "raw", "raw");
    header.has_encoding = true;
  } else if (field == "sizes") {
    const std::vector<double> n = numbers(text, field, value, 3);
    const auto side = [&](std::size_t axis) { return whole(text, field, n[axis], 1, nrrd_longest_side); };
    header.sizes = Index3(side(0), side(1), side(2));
  } else if (field == "space directions") {
    header.length = voxel_length(text, value);
  } else if (field == "space origin") {
    const std::vector<double> n = numbers(text, field, value, 3);
    header.origin = Vec3(n[0], n[1], n[2]);
  } else if (field == "space units") {
    demand(value == R"("m" "m" "m")", R"("m" "m" "m")");
  } else if (field == "data file" || field == "datafile" || field == "line skip" || field == "byte skip") {
    text.fail(fmt::format("{}: is not supported; the voxels must follow the header", field));
  }
  // Other fields (kinds, content, endian, ...) say nothing about where a voxel is.
}

IndexBox read_enclosure(const TextReader& text, std::string_view value) {
  const std::vector<double> n = numbers(text, "enclosure", value, 6);
  IndexBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = whole(text, "enclosure", n[static_cast<std::size_t>(axis)], 0, nrrd_longest_side - 1);
    box.max[axis] = whole(text, "enclosure", n[static_cast<std::size_t>(axis) + 3], 0, nrrd_longest_side - 1);
  }
  return box;
}

/// `scene:=SIZES FIRST MIN`: voxels of the scene, the index of the file's first voxel in it, and its lower corner in
/// metres.
void read_scene(const TextReader& text, std::string_view value, NrrdHeader& header) {
  const std::vector<double> n = numbers(text, "scene", value, 9);
  Grid& scene = header.scene.emplace();
  Index3& first = header.first.emplace();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    scene.size[a] = whole(text, "scene", n[axis], 1, nrrd_longest_side);
    first[a] = whole(text, "scene", n[axis + 3], 0, nrrd_longest_side - 1);
    scene.min[a] = n[axis + 6];
  }
}

NrrdHeader read_nrrd_header(TextReader& text) {
  if (!text.next_line() || text.rest_of_line().size() != 8 || text.rest_of_line().substr(0, 7) != "NRRD000") {
    throw InputError(text.name() + ": is not a NRRD file (its first line must be 'NRRD0005')");
  }
  NrrdHeader header;
  while (text.next_line()) {
    const std::string_view line = text.rest_of_line();
    if (line.empty()) return header;
    if (line[0] == '#') continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || colon + 1 == line.size()) {
      text.fail(fmt::format("{} must be like 'field: value' or 'key:=value'", in_quotes(line)));
    }
    const std::string_view field = line.substr(0, colon);
    if (line[colon + 1] != '=') {
      read_field(text, field, trimmed(line.substr(colon + 1)), header);
    } else if (field == format_key) {
      require_known_format(numbers(text, field, trimmed(line.substr(colon + 2)), 1)[0], map_format, text.name());
    } else if (field == "enclosure") {
      header.enclosure = read_enclosure(text, trimmed(line.substr(colon + 2)));
    } else if (field == "scene") {
      read_scene(text, trimmed(line.substr(colon + 2)), header);
    }
  }
  throw InputError(text.name() + ": the header ends without an empty line; the file is cut off");
}

/// The centre of voxel 0 on one axis. Half a voxel there and back may differ in the last bit from where it started, so
/// look for the double near it that leads back exactly.
double origin(double min, double length) {
  const double half = 0.5 * length;
  double below = min + half, above = below;
  for (int step = 0; step < 4; ++step) {
    if (below - half == min) return below;
    if (above - half == min) return above;
    below = std::nextafter(below, -std::numeric_limits<double>::infinity());
    above = std::nextafter(above, std::numeric_limits<double>::infinity());
  }
  return min + half;
}

}  // namespace

Nrrd parse_nrrd(std::string_view bytes, const std::string& name) {
  TextReader text(bytes, name);
  const NrrdHeader header = read_nrrd_header(text);
  require(header.has_type, name, ": the header has no field 'type'");
  require(header.has_encoding, name, ": the header has no field 'encoding'");
  require(header.sizes.has_value(), name, ": the header has no field 'sizes'");
  require(header.length.has_value(), name, ": the header has no field 'space directions'");
  require(header.origin.has_value(), name, ": the header has no field 'space origin'");
  const auto voxels = static_cast<std::size_t>(header.sizes->cast<std::int64_t>().prod());
  if (text.rest().size() != voxels) {
    throw InputError(fmt::format("{}: sizes {} {} {} need {} bytes, but {} follow the header", name, header.sizes->x(),
                                 header.sizes->y(), header.sizes->z(), voxels, text.rest().size()));
  }
  Nrrd nrrd{{*header.origin - Vec3::Constant(0.5 * *header.length), *header.length, *header.sizes},
            {Index3::Zero(), *header.sizes - Index3::Ones()},
            header.enclosure,
            text.rest()};
  if (!header.scene) return nrrd;
  nrrd.grid = {header.scene->min, *header.length, header.scene->size};
  const auto in_scene = [&](const IndexBox& box) {
    const IndexBox moved{box.min + *header.first, box.max + *header.first};
    require(nrrd.grid.contains(moved.min) && nrrd.grid.contains(moved.max), name,
            ": the key 'scene' says that there are ", nrrd.grid.size.transpose(),
            " voxels, among which those of the file are not");
    return moved;
  };
  nrrd.stored = in_scene(nrrd.stored);
  nrrd.enclosure = nrrd.enclosure ? in_scene(*nrrd.enclosure) : nrrd.stored;
  return nrrd;
}

std::string nrrd_header(const Grid& grid, const IndexBox& enclosure, const IndexBox& stored) {
  std::string header = "NRRD0005\n# Labels: 0 unmarked, 1 occupied, 2 empty, 3 occluded, 4 occplane\n";
  header += "type: uint8\ndimension: 3\nspace dimension: 3\n";
  const Index3 size = stored.size();
  // Of the whole scene to the last bit; of a part, the key `scene` has the bits.
  const bool is_whole = stored.size() == grid.size;
  const Vec3 first = is_whole ? Vec3(origin(grid.min.x(), grid.length), origin(grid.min.y(), grid.length),
                                     origin(grid.min.z(), grid.length))
                              : grid.center(stored.min);
  const IndexBox inside{enclosure.min - stored.min, enclosure.max - stored.min};
  header += fmt::format("sizes: {} {} {}\n", size.x(), size.y(), size.z());
  header += fmt::format("space directions: ({0},0,0) (0,{0},0) (0,0,{0})\n", grid.length);
  header += "kinds: domain domain domain\nspace units: \"m\" \"m\" \"m\"\nencoding: raw\n";
  header += fmt::format("space origin: ({},{},{})\n", first.x(), first.y(), first.z());
  header += fmt::format("{}:={}\n", format_key, map_format);
  header += fmt::format("enclosure:={} {} {} {} {} {}\n", inside.min.x(), inside.min.y(), inside.min.z(),
                        inside.max.x(), inside.max.y(), inside.max.z());
  if (!is_whole) {
    header += fmt::format("scene:={} {} {} {} {} {} {} {} {}\n", grid.size.x(), grid.size.y(), grid.size.z(),
                          stored.min.x(), stored.min.y(), stored.min.z(), grid.min.x(), grid.min.y(), grid.min.z());
  }
  return header + "\n";
}

}  // namespace vantage
