#include "vantage/formats/mesh_parsers.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/ply.hpp"
#include "vantage/formats/polygon.hpp"

namespace vantage {
namespace {

constexpr std::size_t most_vertices = std::numeric_limits<int>::max();

Vec3 read_vertex(TextReader& text) {
  const double x = text.finite_number("x");
  const double y = text.finite_number("y");
  return {x, y, text.finite_number("z")};
}

/// The line up to a comment sign.
void drop_comment(TextReader& text) {
  text.set_rest_of_line(text.rest_of_line().substr(0, text.rest_of_line().find('#')));
}

/// Moves to the next statement of an OBJ file, which goes on in the next line after a backslash. `joined` holds the
/// text of one that does.
bool next_statement(TextReader& text, std::string& joined) {
  if (!text.next_line()) return false;
  drop_comment(text);
  if (!trimmed(text.rest_of_line()).ends_with('\\')) return true;
  joined.clear();
  for (bool goes_on = true; goes_on;) {
    std::string_view line = trimmed(text.rest_of_line());
    goes_on = line.ends_with('\\');
    if (goes_on) line.remove_suffix(1);
    joined.append(line).append(" ");
    if (!goes_on || !text.next_line()) break;
    drop_comment(text);
  }
  text.set_rest_of_line(joined);
  return true;
}

/// A corner of an OBJ face: `i`, `i/t`, `i//n` or `i/t/n`, from 1, or from the last vertex backwards where negative.
int obj_corner(const TextReader& text, std::string_view word, std::size_t vertices) {
  const auto index = to_integer(word.substr(0, word.find('/')));
  if (!index) text.fail(fmt::format("corner {} of a face: must be like 3, 3/1, 3//2 or 3/1/2", in_quotes(word)));
  const auto count = static_cast<std::int64_t>(vertices);
  const std::int64_t from_zero = *index > 0 ? *index - 1 : count + *index;
  if (*index == 0 || *index > count || from_zero < 0) {
    text.fail(fmt::format("corner {} of a face: vertices go from 1 to {} here", *index, vertices));
  }
  return static_cast<int>(from_zero);
}

/// The list of vertices of an element of a PLY file.
const PlyColumn& corner_list(const PlyElement& element, const std::string& name) {
  const PlyColumn* corners = element.find("vertex_indices");
  if (corners == nullptr) corners = element.find("vertex_index");
  if (corners == nullptr || !corners->is_list)
    throw InputError(fmt::format("{}: element '{}' has no list 'vertex_indices'", name, element.name));
  return *corners;
}

int ply_corner(const TriangleMesh& mesh, double index, std::string_view what, std::size_t row,
               const std::string& name) {
  require(index >= 0 && index < static_cast<double>(mesh.vertices.size()) && index == std::floor(index), name, ": ",
          what, " ", row, " has the vertex ", index, ": vertices go from 0 to ", mesh.vertices.size() - 1);
  return static_cast<int>(index);
}

void append_faces(TriangleMesh& mesh, const PlyElement& faces, const std::string& name) {
  const PlyColumn& corners = corner_list(faces, name);
  std::vector<int> polygon;
  std::size_t begin = 0;
  for (std::size_t face = 0; face < faces.rows; ++face) {
    polygon.clear();
    for (std::size_t i = begin; i < corners.ends[face]; ++i)
      polygon.push_back(ply_corner(mesh, corners.values[i], "face", face, name));
    begin = corners.ends[face];
    append_polygon(mesh, polygon, name, face);
  }
}

/// Strips of triangles, which share two corners with the one before and turn the other way every time; -1 starts again.
void append_strips(TriangleMesh& mesh, const PlyElement& strips, const std::string& name) {
  const PlyColumn& corners = corner_list(strips, name);
  std::size_t i = 0;
  for (std::size_t row = 0; row < strips.rows; ++row) {
    std::vector<int> strip;
    for (; i < corners.ends[row]; ++i) {
      if (corners.values[i] == -1) {
        strip.clear();
        continue;
      }
      strip.push_back(ply_corner(mesh, corners.values[i], "strip", row, name));
      const std::size_t count = strip.size();
      if (count < 3) continue;
      std::array<int, 3> triangle{strip[count - 3], strip[count - 2], strip[count - 1]};
      if (count % 2 == 0) std::swap(triangle[0], triangle[1]);
      append_polygon(mesh, triangle, name, row);
    }
  }
}

/// The next line of an OFF file without its comment that has a word.
void next_off_line(TextReader& text, std::string_view expected, std::uint64_t number = 0) {
  while (text.next_line()) {
    drop_comment(text);
    if (!text.at_end_of_line()) return;
  }
  throw InputError(fmt::format("{}: ends before {} {}; the file is cut off", text.name(), expected, number));
}

/// Reads the first line, `OFF` or a variant with colours, normals or texture, which need no different treatment.
void read_off_keyword(TextReader& text) {
  next_off_line(text, "line");
  const std::string_view line = trimmed(text.rest_of_line());
  for (const std::string_view keyword : {"STCNOFF", "STCOFF", "STNOFF", "CNOFF", "STOFF", "COFF", "NOFF", "OFF"}) {
    if (line.substr(0, keyword.size()) != keyword) continue;
    text.set_rest_of_line(line.substr(keyword.size()));  // the counts may follow, with or without a blank
    if (trimmed(text.rest_of_line()).substr(0, 6) == "BINARY") text.fail("binary OFF is not supported; must be ASCII");
    return;
  }
  throw InputError(text.name() + ": is not an OFF file (its first line must be 'OFF')");
}

}  // namespace

TriangleMesh parse_ply_mesh(std::string_view bytes, const std::string& name) {
  const Ply ply = parse_ply(bytes, name);
  const PlyElement* vertices = ply.find("vertex");
  if (vertices == nullptr || vertices->rows == 0) throw InputError(name + ": has no vertices");
  require(vertices->rows <= most_vertices, name, ": has ", vertices->rows, " vertices, must be at most ",
          most_vertices);
  TriangleMesh mesh;
  const PlyColumn& x = scalar_column(*vertices, "x", name);
  const PlyColumn& y = scalar_column(*vertices, "y", name);
  const PlyColumn& z = scalar_column(*vertices, "z", name);
  mesh.vertices.reserve(vertices->rows);
  for (std::size_t i = 0; i < vertices->rows; ++i) {
    const Vec3 vertex(x.values[i], y.values[i], z.values[i]);
    require(vertex.allFinite(), name, ": vertex ", i, " is at ", in_brackets(vertex), ": must be finite numbers");
    mesh.vertices.push_back(vertex);
  }
  const PlyElement* faces = ply.find("face");
  const PlyElement* strips = ply.find("tristrips");
  if (faces == nullptr && strips == nullptr)
    throw InputError(name + ": has no faces; it is a point cloud, a mesh is needed");
  if (faces != nullptr) append_faces(mesh, *faces, name);
  if (strips != nullptr) append_strips(mesh, *strips, name);
  return mesh;
}

TriangleMesh parse_obj_mesh(std::string_view bytes, const std::string& name) {
  TextReader text(bytes, name);
  TriangleMesh mesh;
  std::vector<int> polygon;
  std::size_t faces = 0;
  std::string joined;
  while (next_statement(text, joined)) {
    const std::string_view keyword = text.word();
    if (keyword == "v") {
      mesh.vertices.push_back(read_vertex(text));  // a weight or colour may follow
      if (mesh.vertices.size() > most_vertices) text.fail("too many vertices");
    } else if (keyword == "f") {
      polygon.clear();
      for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
        polygon.push_back(obj_corner(text, word, mesh.vertices.size()));
      }
      if (polygon.size() < 3) text.fail(fmt::format("a face with {} corners: must be at least 3", polygon.size()));
      append_polygon(mesh, polygon, name, faces++);
    }
    // Normals, texture, groups and materials say nothing about the shape.
  }
  if (mesh.vertices.empty()) throw InputError(name + ": has no line 'v x y z'; it is not an OBJ mesh");
  return mesh;
}

TriangleMesh parse_off_mesh(std::string_view bytes, const std::string& name) {
  TextReader text(bytes, name);
  read_off_keyword(text);
  if (text.at_end_of_line()) next_off_line(text, "line");
  const std::uint64_t vertices = text.count("the number of vertices");
  const std::uint64_t faces = text.count("the number of faces");
  if (vertices > most_vertices) text.fail(fmt::format("{} vertices: must be at most {}", vertices, most_vertices));
  TriangleMesh mesh;
  for (std::uint64_t i = 0; i < vertices; ++i) {
    next_off_line(text, "vertex", i);
    mesh.vertices.push_back(read_vertex(text));
  }
  std::vector<int> polygon;
  for (std::uint64_t face = 0; face < faces; ++face) {
    next_off_line(text, "face", face);
    const std::uint64_t corners = text.count("the number of corners");
    polygon.clear();
    for (std::uint64_t i = 0; i < corners; ++i) {
      const std::int64_t index = text.integer("a corner of the face");
      if (index < 0 || index >= static_cast<std::int64_t>(vertices)) {
        text.fail(fmt::format("the face has the vertex {}: vertices go from 0 to {}", index,
                              static_cast<std::int64_t>(vertices) - 1));
      }
      polygon.push_back(static_cast<int>(index));
    }
    append_polygon(mesh, polygon, name, face);
  }
  return mesh;
}

}  // namespace vantage
