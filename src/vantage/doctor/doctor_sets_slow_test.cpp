#include <gtest/gtest.h>

#include <numbers>

#include "support/test_folder.hpp"
#include "vantage/doctor/doctor_test_util.hpp"
#include "vantage/simulation/mesh_tools.hpp"
#include "vantage/simulation/objects.hpp"
#include "vantage/simulation/range_scanner.hpp"

// Made-up sets, every mistake made in each: few frames of one simple thing leave much to be mistaken for something
// else.
namespace vantage {
namespace {

using Matrix = Eigen::Matrix4d;
using test::SetOnDisk;

void add_box(TriangleMesh& mesh, const Vec3& low, const Vec3& high) {
  const auto first = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                               (i & 4) != 0 ? high.z() : low.z());
  constexpr int faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& face : faces) mesh.triangles.emplace_back(first + face[0], first + face[1], first + face[2]);
}

/// A bottle with a label's edge and a handle-less neck: round, so that its turn about itself hardly shows.
TriangleMesh bottle() {
  constexpr double profile[][2] = {{0, 0},        {0.04, 0},      {0.042, 0.06}, {0.04, 0.14},
                                   {0.015, 0.19}, {0.015, 0.235}, {0, 0.24}};  // radius and height, metres
  constexpr int around = 48, rings = 7;
  TriangleMesh mesh;
  for (const auto& [radius, height] : profile) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height - 0.12);
    }
  }
  for (int ring = 0; ring + 1 < rings; ++ring) {
    for (int i = 0; i < around; ++i) {
      const int a = ring * around + i, b = ring * around + (i + 1) % around;
      if (ring > 0) mesh.triangles.emplace_back(a, b, b + around);
      if (ring + 2 < rings) mesh.triangles.emplace_back(a, b + around, a + around);
      if (ring == 0) mesh.triangles.back() = {a, b + around, a + around};
    }
  }
  return mesh;
}

TriangleMesh object_named(const std::string& name) {
  TriangleMesh mesh;
  if (name == "bottle") return bottle();
  if (name == "cube") {
    add_box(mesh, {-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1});
    return mesh;
  }
  return centred_and_scaled(make_object(name), name == "sphere" ? 0.2 : 0.25);
}

struct MadeUp {
  std::string object;
  bool on_table;  // 1.2 m x 1 m
  bool is_ring;   // else the views wind up from low to high, and their distances differ
  double noise;   // metres, of each depth

  [[nodiscard]] std::string name() const {
    return concat(object, on_table ? " on a table" : " alone", is_ring ? ", ring" : ", spiral", ", noise ", noise);
  }
};

constexpr double focal = 300;  // pixels

SetOnDisk made(const MadeUp& about, const std::filesystem::path& folder, std::uint64_t seed) {
  TriangleMesh scene = object_named(about.object);
  double lowest = 0;
  for (const Vec3& vertex : scene.vertices) lowest = std::min(lowest, vertex.z());
  if (about.on_table) add_box(scene, {-0.55, -0.6, lowest - 0.05}, {0.65, 0.4, lowest - 0.001});
  const RangeScanner scanner(scene);
  RangeCamera camera = camera_from_intrinsics(focal, focal, 163.5, 117.5, {320, 240});
  Random random(seed);
  SetOnDisk set;
  set.images = folder;
  set.intrinsics << focal, 0, 163.5, 0, focal, 117.5, 0, 0, 1;
  constexpr int frames = 16;
  for (int i = 0; i < frames; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / frames * (about.is_ring ? 1 : 2);
    const double elevation = radians(about.is_ring ? 30.0 : 12 + 4.0 * i);
    const double distance = about.is_ring ? 0.8 : 0.65 + 0.02 * ((7 * i) % 16);
    const Vec3 position = distance * Vec3(std::cos(azimuth) * std::cos(elevation),
                                          std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
    const View view = view_towards(position, {0, 0, 0.01});
    RangeImage image = scanner.scan(camera, view);
    for (float& depth : image.depth) {
      // Like most sensors it does not tell apart what it did not measure and where nothing is.
      if (RangeImage::is_hit(depth))
        depth += static_cast<float>(about.noise * random.normal());
      else
        depth = RangeImage::unknown;
    }
    const std::string name = concat("frame-", 100 + i);
    write_depth_png(folder / (name + ".depth.png"), image);
    // The world is the robot's: the object stands somewhere before it.
    const Matrix robot_from_object = Pose(Eigen::Translation3d(0.6, -0.25, 0.3)).matrix();
    set.frames.push_back({name, robot_from_object * view.world_from_sensor.matrix()});
  }
  return set;
}

Gray16 with_values(Gray16 image, const std::function<double(double, int, int)>& change) {
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const int column = static_cast<int>(i) % image.resolution.columns,
              row = static_cast<int>(i) / image.resolution.columns;
    if (image.values[i] == 0 || image.values[i] == 65535) continue;
    image.values[i] = static_cast<std::uint16_t>(std::lround(change(image.values[i], column, row)));
  }
  return image;
}

std::vector<test::Mistake> more_mistakes(const SetOnDisk& good, const DoctorOptions& options) {
  std::vector<test::Mistake> all = test::all_mistakes(good, options);
  const auto add = [&](const char* check, const char* fix, SetOnDisk set) {
    all.push_back({check, fix, std::move(set), options});
  };
  Pose hand_from_sensor_pose = Pose(Eigen::Translation3d(0.05, -0.03, 0.08));
  hand_from_sensor_pose.rotate(Eigen::AngleAxisd(radians(100), Vec3(0.3, -0.5, 0.8).normalized()));
  const Matrix hand_from_sensor = hand_from_sensor_pose.matrix();
  add("hand-eye", "", good.with_poses([&](const Matrix& m) -> Matrix { return m * hand_from_sensor.inverse(); }));
  add("rotation", "x y z w", good.with_poses([](Matrix m) -> Matrix {
    const Eigen::Quaterniond q(Mat3(m.topLeftCorner<3, 3>()));
    m.topLeftCorner<3, 3>() = Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()).toRotationMatrix();
    return m;
  }));
  add("rotation", "transpose", good.with_poses([](Matrix m) -> Matrix {
    m.topLeftCorner<3, 3>().transposeInPlace();
    return m;
  }));
  add("pose-direction", "invert", good.with_poses([](const Matrix& m) -> Matrix {
    return (m * test::turn(Vec3(1, -1, -1).asDiagonal().toDenseMatrix())).inverse();
  }));
  add("position-unit", "--unit", good.with_poses([](Matrix m) -> Matrix {
    m.topRightCorner<3, 1>() *= 1000;
    return m;
  }));
  SetOnDisk along = good;
  along.pixels = [](Gray16 image) {
    return with_values(std::move(image), [](double depth, int column, int row) {
      return depth * Vec3((column - 163.5) / focal, (row - 117.5) / focal, 1).norm();
    });
  };
  add("depth-kind", "--depth-along ray", along);
  SetOnDisk disparity = good;
  disparity.pixels = [](Gray16 image) {
    return with_values(std::move(image), [](double depth, int, int) { return 15e6 / depth; });
  };
  add("depth-kind", "", disparity);
  SetOnDisk swapped = good;
  std::swap(swapped.intrinsics(0, 2), swapped.intrinsics(1, 2));
  add("intrinsics", "", swapped);
  SetOnDisk empty = good;
  int number = 0;
  empty.pixels = [number](Gray16 image) mutable {
    if (number++ == 3) std::fill(image.values.begin(), image.values.end(), std::uint16_t{0});
    return image;
  };
  add("frames", "", empty);
  SetOnDisk one = good;
  one.frames.resize(1);
  add("frames", "", one);
  return all;
}

std::string said(const Diagnosis& diagnosis) {
  std::string text;
  for (const Finding& finding : diagnosis.findings) text += concat("\n      ", finding.check, ": ", finding.fix);
  return text.empty() ? " nothing" : text;
}

bool names(const Diagnosis& diagnosis, const test::Mistake& mistake) {
  return std::any_of(diagnosis.findings.begin(), diagnosis.findings.end(), [&](const Finding& finding) {
    return finding.check == mistake.check && finding.fix.find(mistake.fix) != std::string::npos;
  });
}

/// Whether the frames still fit each other with the mistake, as a turn or a mirror image of the world.
bool makes_no_difference(const MadeUp& about, const test::Mistake& mistake) {
  if (mistake.check == "time") return about.is_ring;  // the whole ring is a step further
  const bool has_mirror = about.object != "cube" && !about.on_table;
  if (mistake.fix == "negate the y row") return has_mirror;
  // In the middle of the image distances along the ray are 1 % longer than depths: the thing is a little larger.
  if (mistake.fix == "--depth-along ray") return !about.on_table;
  // Turned about its middle a sphere is the same.
  const bool turns = mistake.check == "rotation" || mistake.check == "sensor-axes" || mistake.check == "pose-direction";
  return about.object == "sphere" && !about.on_table && turns && mistake.fix != "divide";
}

Diagnosis diagnose(const SetOnDisk& set, const DoctorOptions& options) {
  const TestFolder folder;
  set.write(folder / "set");
  return examine(folder / "set", options, [](const std::string&) {});
}

TEST(DoctorOnMadeUpSets, FindsMistakesAndPassesUntouchedSets) {
  std::vector<MadeUp> sets;
  for (const char* object : {"mug", "sphere", "cube", "bottle"}) {
    for (const bool on_table : {false, true}) {
      for (const bool is_ring : {true, false}) {
        for (const double noise : {0.0, 0.001}) sets.push_back({object, on_table, is_ring, noise});
      }
    }
  }
  int pairs = 0, named = 0;
  for (const MadeUp& about : sets) {
    const TestFolder images;
    const SetOnDisk good = made(about, images.path(), 17);
    const Diagnosis healthy = diagnose(good, {});
    EXPECT_TRUE(healthy.healthy()) << about.name() << " untouched:" << said(healthy);
    if (about.noise == 0) continue;
    for (const test::Mistake& mistake : more_mistakes(good, {})) {
      if (makes_no_difference(about, mistake)) continue;
      const Diagnosis diagnosis = diagnose(mistake.set, mistake.options);
      ++pairs;
      const bool is_named = names(diagnosis, mistake);
      named += is_named ? 1 : 0;
      if (!is_named)
        std::cout << about.name() << ": missed " << mistake.check << " (" << mistake.fix << "):" << said(diagnosis)
                  << std::endl;
    }
  }
  std::cout << sets.size() << " untouched sets; " << named << " of " << pairs << " mistakes named\n";
  EXPECT_GE(named, 0.95 * pairs);
}

}  // namespace
}  // namespace vantage
