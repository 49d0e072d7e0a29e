// A second evaluator of candidate views, written straight from the specification and the paper, sharing no code with
// the library: plain loops, plain arrays, a naive walk along each ray. It reads a dumped map and what `vantage evaluate
// --json` says about it, computes everything again and compares. Usage: second_evaluator MAP.nrrd EVALUATION.json N
// RADIUS HFOV VFOV COLUMNS ROWS CX CY CZ [NEAR FAR]; angles in degrees, C the current position. Exit code 0 where both
// agree.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

using V = std::array<double, 3>;

V operator+(V a, V b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
V operator-(V a, V b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
V operator*(V a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot(V a, V b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
V cross(V a, V b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
V unit(V a) { return a * (1 / std::sqrt(dot(a, a))); }

struct Map {
  std::array<int, 3> size{};
  V corner{};
  double length = 0;
  std::vector<unsigned char> labels;
  std::map<std::size_t, V> normals;

  [[nodiscard]] std::size_t at(const std::array<int, 3>& i) const {
    return (static_cast<std::size_t>(i[2]) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(i[1])) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(i[0]);
  }
};

[[noreturn]] void fail(const std::string& text) {
  std::cerr << "second_evaluator: " << text << '\n';
  std::exit(1);
}

Map read_map(const std::string& path) {
  Map map;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail("cannot read " + path);
  std::string line;
  while (std::getline(file, line) && !line.empty()) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    std::string value = line.substr(colon + 2);
    std::replace_if(
        value.begin(), value.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
    std::istringstream numbers(value);
    if (line.rfind("sizes", 0) == 0) numbers >> map.size[0] >> map.size[1] >> map.size[2];
    if (line.rfind("space origin", 0) == 0) numbers >> map.corner[0] >> map.corner[1] >> map.corner[2];
    if (line.rfind("space directions", 0) == 0) numbers >> map.length;
  }
  const V half{map.length / 2, map.length / 2, map.length / 2};
  map.corner = map.corner - half;  // the header gives the centre of voxel 0
  map.labels.resize(static_cast<std::size_t>(map.size[0]) * static_cast<std::size_t>(map.size[1]) *
                    static_cast<std::size_t>(map.size[2]));
  file.read(reinterpret_cast<char*>(map.labels.data()), static_cast<std::streamsize>(map.labels.size()));
  if (!file) fail("the map is shorter than its sizes say");

  std::ifstream surface(path.substr(0, path.size() - 5) + ".ply", std::ios::binary);
  std::size_t vertices = 0;
  while (std::getline(surface, line) && line != "end_header") {
    if (line.rfind("element vertex ", 0) == 0) vertices = std::stoul(line.substr(15));
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    std::array<float, 7> record{};
    surface.read(reinterpret_cast<char*>(record.data()), sizeof record);
    std::array<int, 3> index{};
    for (std::size_t a = 0; a < 3; ++a) {
      index[a] = static_cast<int>(std::floor((static_cast<double>(record[a]) - map.corner[a]) / map.length));
    }
    map.normals[map.at(index)] = {record[3], record[4], record[5]};
  }
  return map;
}

struct Camera {
  double h, v;  // apertures, radians
  int columns, rows;
  double near, far;
};

/// How often each label is seen: what is certain, and what is possible. They differ where rays pass exactly through
/// edges of voxels: which of the voxels around the edge such a ray meets hangs on the last bit of any computation.
struct Counts {
  std::array<int, 5> certain{}, possible{};
  double cosines = 0;  // of the certain occupied voxels

  [[nodiscard]] bool exact() const { return certain == possible; }
};

struct Ray {
  V origin, direction;
  double enter, leave;  // the part inside the scene and the camera's depth limits
};

using Index = std::array<int, 3>;

/// The voxels in which a ray may end; `nothing` among them where it may leave the scene. Amanatides and Woo: from the
/// voxel in which the ray enters, always across the nearest boundary; boundaries that are equally near are crossed in
/// every order.
constexpr std::size_t nothing = static_cast<std::size_t>(-1);

std::set<std::size_t> ends(const Map& map, const Ray& ray) {
  Index index{};
  V next{};
  const auto boundary = [&](std::size_t a) {
    if (std::abs(ray.direction[a]) < 1e-15) return 1e30;
    const double plane = map.corner[a] + (index[a] + (ray.direction[a] > 0 ? 1 : 0)) * map.length;
    return (plane - ray.origin[a]) / ray.direction[a];
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const double start = ray.origin[a] + ray.direction[a] * ray.enter;
    index[a] = std::clamp(static_cast<int>(std::floor((start - map.corner[a]) / map.length)), 0, map.size[a] - 1);
    next[a] = boundary(a);
  }
  std::set<std::size_t> found;
  const auto solid = [&](const Index& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (at[a] < 0 || at[a] >= map.size[a]) return false;
    }
    return map.labels[map.at(at)] != 2;
  };
  double t = ray.enter;
  while (t < ray.leave) {
    if (solid(index)) {
      found.insert(map.at(index));
      return found;
    }
    t = std::min({next[0], next[1], next[2]});
    std::vector<std::size_t> crossed;
    for (std::size_t a = 0; a < 3; ++a) {
      if (next[a] < t + 1e-9) crossed.push_back(a);
    }
    bool goes_on = false;
    std::sort(crossed.begin(), crossed.end());
    do {  // every order; the last voxel is the same for all
      Index at = index;
      bool stopped = false;
      for (std::size_t i = 0; i + 1 < crossed.size() && !stopped; ++i) {
        at[crossed[i]] += ray.direction[crossed[i]] > 0 ? 1 : -1;
        stopped = solid(at);
        if (stopped) found.insert(map.at(at));
      }
      goes_on = goes_on || !stopped;
    } while (std::next_permutation(crossed.begin(), crossed.end()));
    if (!goes_on) return found;
    for (const std::size_t a : crossed) {
      index[a] += ray.direction[a] > 0 ? 1 : -1;
      if (index[a] < 0 || index[a] >= map.size[a]) t = 1e30;
      next[a] = boundary(a);
    }
  }
  found.insert(nothing);
  return found;
}

Counts look(const Map& map, const Camera& camera, V position, V target) {
  const V forward = unit(target - position);
  const V up = std::abs(forward[2]) > 0.999 ? V{0, 1, 0} : V{0, 0, 1};
  const V right = unit(cross(forward, up));
  const V down = cross(forward, right);
  std::set<std::size_t> certain;
  std::set<std::size_t> possible;
  for (int j = 0; j < camera.rows; ++j) {
    for (int i = 0; i < camera.columns; ++i) {
      const double u = (2.0 * i + 1) / camera.columns - 1;
      const double w = (2.0 * j + 1) / camera.rows - 1;
      Ray ray{position, forward + right * (u * std::tan(camera.h / 2)) + down * (w * std::tan(camera.v / 2)),
              camera.near, camera.far};
      for (std::size_t a = 0; a < 3; ++a) {
        const double lo = map.corner[a] - position[a];
        const double hi = lo + map.size[a] * map.length;
        if (std::abs(ray.direction[a]) < 1e-15) {
          if (lo > 0 || hi < 0) ray.leave = -1;
          continue;
        }
        ray.enter = std::max(ray.enter, std::min(lo / ray.direction[a], hi / ray.direction[a]));
        ray.leave = std::min(ray.leave, std::max(lo / ray.direction[a], hi / ray.direction[a]));
      }
      if (ray.enter >= ray.leave) continue;
      const std::set<std::size_t> found = ends(map, ray);
      if (found.size() == 1) certain.insert(*found.begin());
      possible.insert(found.begin(), found.end());
    }
  }
  Counts counts;
  certain.erase(nothing);
  possible.erase(nothing);
  for (const std::size_t voxel : certain) {
    ++counts.certain[map.labels[voxel]];
    if (map.labels[voxel] == 1) counts.cosines += std::max(0.0, -dot(forward, map.normals.at(voxel)));
  }
  for (const std::size_t voxel : possible) ++counts.possible[map.labels[voxel]];
  return counts;
}

double f(double x, double a) {  // eqs 4 to 6 as printed
  if (x <= a) return -2 / (a * a * a) * x * x * x + 3 / (a * a) * x * x;
  const double c = (a - 1) * (a - 1) * (a - 1);
  return -2 / c * x * x * x + 3 * (a + 1) / c * x * x - 6 * a / c * x + (3 * a - 1) / c;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 12 && argc != 14) fail("wrong number of arguments");
  const Map map = read_map(argv[1]);
  std::ifstream file(argv[2]);
  const nlohmann::json evaluation = nlohmann::json::parse(file);
  const auto number = [&](int i) { return std::atof(argv[i]); };
  const double pi = std::acos(-1.0);
  const Camera camera{number(5) * pi / 180,        number(6) * pi / 180,       static_cast<int>(number(7)),
                      static_cast<int>(number(8)), argc > 12 ? number(12) : 0, argc > 12 ? number(13) : 4.5};
  const V current{number(9), number(10), number(11)};
  const V center{0, 0, 0};

  std::map<int, long> labels;
  for (const unsigned char label : map.labels) ++labels[label];
  const std::array<const char*, 5> names{"unmarked", "occupied", "empty", "occluded", "occplane"};
  for (int l = 0; l < 5; ++l) {
    const long said = evaluation.at("labels").at(names[static_cast<std::size_t>(l)]).get<long>();
    if (said != labels[l]) fail(std::string("label counts differ: ") + names[static_cast<std::size_t>(l)]);
  }

  int compared = 0;
  int factors_compared = 0;
  const double radius = number(4);
  for (const auto& view : evaluation.at("views")) {
    const auto position = view.at("position").get<V>();
    if (std::abs(std::sqrt(dot(position, position)) - radius) > 1e-9) fail("a view is not on the sphere");
    const Counts c = look(map, camera, position, center);
    const auto compare = [&](const char* name, std::size_t label) {
      const int said = view.at(name).get<int>();
      const double slack = std::max(1.0, 0.001 * c.possible[label]);
      if (said < c.certain[label] - slack || said > c.possible[label] + slack) {
        fail("view " + view.at("index").dump() + ": " + name + " is " + std::to_string(said) + ", here " +
             std::to_string(c.certain[label]) + " to " + std::to_string(c.possible[label]));
      }
      return said == c.certain[label];
    };
    const std::array<bool, 4> same{compare("n_um", 0), compare("n_oc", 1), compare("n_occluded", 3),
                                   compare("n_op", 4)};
    ++compared;
    if (!c.exact() || !std::all_of(same.begin(), same.end(), [](bool b) { return b; })) continue;
    const double n_oc = c.certain[1];
    const double n_op = c.certain[4];
    const double all = n_oc + n_op + c.certain[0];
    const double x_oc = all > 0 ? n_oc / all : 0;
    const double x_op = all > 0 ? n_op / all : 0;
    const double x = std::acos(std::clamp(dot(unit(position), unit(current)), -1.0, 1.0)) / pi;
    const double area = all > 0 ? f(x_oc, 0.2) + f(x_op, 0.8) : 0;
    const double navigation = (0.2 - 1) * x * x + 1;
    const double quality = n_oc > 0 ? c.cosines / n_oc : 0;
    const double occlusion = n_op / (camera.columns * camera.rows);
    const std::map<std::string, double> expected{{"x_oc", x_oc},
                                                 {"x_op", x_op},
                                                 {"f_area", area},
                                                 {"f_navigation", navigation},
                                                 {"f_quality", quality},
                                                 {"f_occlusion", occlusion},
                                                 {"utility", area * (quality + navigation + occlusion)}};
    for (const auto& [name, value] : expected) {
      if (std::abs(view.at(name).get<double>() - value) > 1e-6) {
        fail("view " + view.at("index").dump() + ": " + name + " is " + view.at(name).dump() + ", here " +
             std::to_string(value));
      }
    }
    ++factors_compared;
  }
  if (compared != static_cast<int>(number(3))) fail("only " + std::to_string(compared) + " views were evaluated");
  if (factors_compared < compared / 2)
    fail("factors could be compared in " + std::to_string(factors_compared) + " views only");
  std::printf("%d views agree, %d of them in every count and so in all factors within 1e-6\n", compared,
              factors_compared);
}
