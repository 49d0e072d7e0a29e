#include "vantage/candidates/candidates.hpp"

#include <array>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/number_text.hpp"
#include "vantage/core/text.hpp"

namespace vantage {
namespace {

using Triangle = std::array<Vec3, 3>;

std::vector<Triangle> icosahedron() {
  const double phi = std::numbers::phi;
  std::vector<Vec3> vertices;
  for (const double one : {-1.0, 1.0}) {
    for (const double golden : {-phi, phi}) {
      // Cyclic permutations of (0, +-1, +-phi).
      vertices.emplace_back(0, one, golden);
      vertices.emplace_back(one, golden, 0);
      vertices.emplace_back(golden, 0, one);
    }
  }
  std::vector<Triangle> faces;
  const double edge = 2 + 1e-9;
  for (std::size_t a = 0; a < vertices.size(); ++a) {
    for (std::size_t b = a + 1; b < vertices.size(); ++b) {
      for (std::size_t c = b + 1; c < vertices.size(); ++c) {
        const bool is_face = (vertices[a] - vertices[b]).norm() < edge && (vertices[b] - vertices[c]).norm() < edge &&
                             (vertices[c] - vertices[a]).norm() < edge;
        if (is_face) {
          faces.push_back({vertices[a].normalized(), vertices[b].normalized(), vertices[c].normalized()});
        }
      }
    }
  }
  return faces;
}

std::vector<Triangle> split_in_four(const std::vector<Triangle>& faces) {
  std::vector<Triangle> finer;
  finer.reserve(4 * faces.size());
  for (const auto& [a, b, c] : faces) {
    const Vec3 ab = (a + b).normalized();
    const Vec3 bc = (b + c).normalized();
    const Vec3 ca = (c + a).normalized();
    finer.push_back({a, ab, ca});
    finer.push_back({b, bc, ab});
    finer.push_back({c, ca, bc});
    finer.push_back({ab, bc, ca});
  }
  return finer;
}

// Not std::stod, which reads "1,5" in some locales, hexadecimal numbers and leading blanks.
double number(const std::string& part, const std::string& what, const std::string& text) {
  const std::optional<double> value = number_from<double>(part);
  require(value && std::isfinite(*value), "candidates '", text, "': ", what, " = '", part, "' is not a number");
  return value.value_or(0);
}

int whole_number(const std::string& part, const std::string& what, const std::string& text) {
  const double value = number(part, what, text);
  require(value == std::floor(value) && std::abs(value) < 1e9, "candidates '", text, "': ", what, " = '", part,
          "' must be a whole number");
  return static_cast<int>(value);
}

}  // namespace

Candidates view_sphere(int count, double radius, const Vec3& center) {
  require(radius > 0 && std::isfinite(radius), "view sphere: radius = ", radius, " m: must be positive");
  constexpr int most = 20 << 14;  // k = 7
  int level_count = 20;
  while (level_count < count && level_count < most) level_count *= 4;
  require(level_count == count, "view sphere: ", count,
          " views: must be 20*4^k, that is 20, 80, 320, 1280, 5120, 20480, 81920 or 327680");
  std::vector<Triangle> faces = icosahedron();
  while (static_cast<int>(faces.size()) < count) faces = split_in_four(faces);

  Candidates candidates;
  candidates.kind = Candidates::Kind::sphere;
  candidates.center = center;
  candidates.views.reserve(faces.size());
  for (const auto& [a, b, c] : faces) {
    candidates.views.push_back(view_towards(center + radius * (a + b + c).normalized(), center));
  }
  return candidates;
}

Candidates view_cube(int n, const Vec3& side, double inner_radius, double outer_radius, const Vec3& center) {
  require(n > 0 && n <= 512, "view cube: n = ", n, ": must be in 1..512");
  require((side.array() > 0).all() && side.allFinite(), "view cube: sides ", side.transpose(), " m: must be positive");
  require(inner_radius >= 0 && outer_radius > inner_radius, "view cube: radii ", inner_radius, " .. ", outer_radius,
          " m: the inner must not be negative and the outer must be greater");
  Candidates candidates;
  candidates.kind = Candidates::Kind::grid;
  candidates.center = center;
  CandidateGrid grid;
  grid.cells_per_side = n;
  grid.spacing = side / n;
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const Vec3 cell(x + 0.5, y + 0.5, z + 0.5);
        const Vec3 offset = (cell.array() - 0.5 * n).matrix().cwiseProduct(grid.spacing);
        const double distance = offset.norm();
        // A cell at the very centre has no direction to look in.
        if (distance < inner_radius || distance > outer_radius || distance < 1e-9) continue;
        candidates.views.push_back(view_towards(center + offset, center));
        grid.cell_of_view.emplace_back(x, y, z);
      }
    }
  }
  require(!candidates.views.empty(), "view cube: no cell lies between the radii ", inner_radius, " and ", outer_radius,
          " m");
  candidates.grid = std::move(grid);
  return candidates;
}

Candidates candidates_from_text(const std::string& text, const Vec3& center) {
  const std::vector<std::string> parts = split(text, ':');
  if (parts[0] == "sphere") {
    require(parts.size() == 3, "candidates '", text, "': must be sphere:N:RADIUS, for example sphere:80:2");
    return view_sphere(whole_number(parts[1], "N", text), number(parts[2], "RADIUS", text), center);
  }
  if (parts[0] == "cube") {
    require(parts.size() == 5, "candidates '", text,
            "': must be cube:N:SIDE:INNER:OUTER, for example cube:17:4.1:0.82:1.9");
    const std::vector<std::string> sides = split(parts[2], ',');
    require(sides.size() == 1 || sides.size() == 3, "candidates '", text, "': SIDE = '", parts[2],
            "' must be one length or three");
    Vec3 side;
    for (std::size_t a = 0; a < 3; ++a) {
      side[static_cast<int>(a)] = number(sides[sides.size() == 1 ? 0 : a], "SIDE", text);
    }
    return view_cube(whole_number(parts[1], "N", text), side, number(parts[3], "INNER", text),
                     number(parts[4], "OUTER", text), center);
  }
  throw InputError(concat("candidates '", text, "': must begin with sphere: or cube:"));
}

}  // namespace vantage
