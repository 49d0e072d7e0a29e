#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <map>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/mesh_parsers.hpp"

namespace vantage {
namespace {

constexpr std::size_t header_bytes = 84;  // 80 of any text, then the number of triangles
constexpr std::size_t triangle_bytes = 50;

/// Gives vertices that are equal to the bit one index: STL repeats them in every triangle.
class Welder {
 public:
  int index(TriangleMesh& mesh, const Vec3& vertex) {
    const auto [entry, is_new] =
        indices_.try_emplace({vertex.x(), vertex.y(), vertex.z()}, static_cast<int>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(vertex);
    return entry->second;
  }

 private:
  std::map<std::array<double, 3>, int> indices_;  // 0 and -0 compare equal, as they should
};

void append_triangle(TriangleMesh& mesh, const Index3& triangle) {
  if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) return;
  mesh.triangles.push_back(triangle);
}

/// The next word in small letters: some writers shout.
std::string next_keyword(TextReader& text) {
  std::string keyword(text.word());
  std::transform(keyword.begin(), keyword.end(), keyword.begin(), [](unsigned char c) { return std::tolower(c); });
  return keyword;
}

bool starts_as_text(std::string_view bytes) {
  const std::string_view head = trimmed(without_byte_order_mark(bytes.substr(0, 512)));
  if (head.find('\0') != std::string_view::npos) return false;
  TextReader text(head, "");
  return text.next_line() && next_keyword(text) == "solid";
}

std::uint32_t uint32_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

TriangleMesh parse_binary(std::string_view bytes, const std::string& name) {
  TriangleMesh mesh;
  Welder welder;
  const std::size_t count = (bytes.size() - header_bytes) / triangle_bytes;
  for (std::size_t t = 0; t < count; ++t) {
    Index3 triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 vertex;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = header_bytes + t * triangle_bytes + 12 * (k + 1) + 4 * axis;  // the normal comes first
        vertex[static_cast<int>(axis)] = static_cast<double>(std::bit_cast<float>(uint32_at(bytes, at)));
      }
      require(vertex.allFinite(), name, ": triangle ", t, " has a corner at ", in_brackets(vertex),
              ": must be finite numbers");
      triangle[static_cast<int>(k)] = welder.index(mesh, vertex);
    }
    append_triangle(mesh, triangle);
  }
  return mesh;
}

TriangleMesh parse_ascii(std::string_view bytes, const std::string& name) {
  TextReader text(bytes, name);
  TriangleMesh mesh;
  Welder welder;
  Index3 triangle;
  int corners = 0;
  bool inside = false;  // between `facet` and `endfacet`
  bool complete = false;
  while (text.next_line_with_words()) {
    const std::string keyword = next_keyword(text);
    if (keyword == "facet") {
      if (inside) text.fail("a facet begins before the last one has ended");
      inside = true;
      corners = 0;
    } else if (keyword == "vertex") {
      if (!inside || corners == 3) text.fail("a vertex that belongs to no facet, or a fourth one in it");
      const double x = text.finite_number("x");
      const double y = text.finite_number("y");
      triangle[corners++] = welder.index(mesh, {x, y, text.finite_number("z")});
    } else if (keyword == "endfacet") {
      if (!inside || corners != 3) text.fail(fmt::format("a facet with {} vertices: must be 3", corners));
      inside = false;
      append_triangle(mesh, triangle);
    } else if (keyword == "endsolid") {
      complete = true;
    } else if (keyword == "solid") {
      complete = false;
    } else if (keyword != "outer" && keyword != "endloop") {
      text.fail(fmt::format("{} is no keyword of an STL file", in_quotes(keyword)));
    }
  }
  if (inside || !complete) throw InputError(name + ": ends without 'endsolid'; the file is cut off");
  return mesh;
}

}  // namespace

TriangleMesh parse_stl_mesh(std::string_view bytes, const std::string& name) {
  // The length tells binary files apart for certain: many of them start with "solid", too.
  const bool has_header = bytes.size() >= header_bytes;
  const std::uint64_t announced = has_header ? uint32_at(bytes, 80) : 0;
  if (has_header && bytes.size() == header_bytes + announced * triangle_bytes) return parse_binary(bytes, name);
  if (starts_as_text(bytes)) return parse_ascii(bytes, name);
  if (!has_header)
    throw InputError(name + ": is not an STL file (shorter than its header and not starting with 'solid')");
  throw InputError(
      fmt::format("{}: {} triangles are announced, which take {} bytes, but the file has {}; it is cut off or "
                  "not an STL file",
                  name, announced, header_bytes + announced * triangle_bytes, bytes.size()));
}

}  // namespace vantage
