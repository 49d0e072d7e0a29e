#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "vantage/core/random.hpp"
#include "vantage/map/integrate.hpp"
#include "vantage/map/voxel_map.hpp"
#include "vantage/sensor/range_camera.hpp"
#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/view.hpp"

/// Random maps and views for property tests, with many of the coincidences that trip geometry up: cameras on lattice
/// planes, edges and corners, axis-parallel and nearly axis-parallel looks, odd grids, images off the axis.
namespace vantage::test {

enum class MapKind { noise, blobs, scans };
inline constexpr MapKind map_kinds[] = {MapKind::noise, MapKind::blobs, MapKind::scans};

template <class Value>
const Value& one_of(Random& random, const std::vector<Value>& values) {
  return values[static_cast<std::size_t>(random.index(static_cast<int>(values.size())))];
}

inline VoxelMap unmarked_map(Random& random) {
  Grid grid;
  grid.length = one_of<double>(random, {0.02, 0.023, 0.125, 0.25});
  Index3 size;
  for (int a = 0; a < 3; ++a) size[a] = one_of<int>(random, {1, 3, 6, 7, 9, 12});
  if (random.uniform() < 0.15) size.x() = 60 + random.index(12);  // rows of more than one word
  const Index3 margin(random.index(4), random.index(4), random.index(4));
  grid.size = size + 2 * margin;
  grid.min = -0.5 * grid.length * grid.size.cast<double>();
  if (random.uniform() < 0.3) grid.min += Vec3(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5));
  return {grid, {margin, margin + size - Index3::Ones()}};
}

template <class Choose>
void set_labels(VoxelMap& map, const Choose& choose) {
  const auto [min, max] = map.enclosure();
  for (int z = min.z(); z <= max.z(); ++z) {
    for (int y = min.y(); y <= max.y(); ++y) {
      for (int x = min.x(); x <= max.x(); ++x) map.set_label({x, y, z}, choose(Index3(x, y, z)));
    }
  }
}

/// Gives four of five occupied voxels a normal.
inline void set_normals(VoxelMap& map, Random& random) {
  for (const Index3& voxel : map.occupied_voxels()) {
    if (random.uniform() < 0.8) map.add_point(voxel, random.unit_vector(), random.uniform());
  }
}

inline void fill_with_noise(VoxelMap& map, Random& random) {
  const double share_empty = one_of<double>(random, {0.1, 0.5, 0.8, 0.97});
  set_labels(map, [&](const Index3&) {
    if (random.uniform() < share_empty) return Label::empty;
    return one_of<Label>(random, {Label::unmarked, Label::occupied, Label::occluded, Label::occplane});
  });
  set_normals(map, random);
}

inline void fill_with_blobs(VoxelMap& map, Random& random) {
  const Vec3 center = map.enclosure_center() + 0.1 * map.grid().length * random.normal3();
  const double radius = map.grid().length * random.uniform(0.8, 5);
  const bool is_unmarked_inside = random.uniform() < 0.5;
  set_labels(map, [&](const Index3& voxel) {
    const double distance = (map.grid().center(voxel) - center).norm();
    if (distance > radius) return random.uniform() < 0.02 ? Label::unmarked : Label::empty;
    if (distance > radius - map.grid().length) return Label::occupied;
    return is_unmarked_inside ? Label::unmarked : Label::occluded;
  });
  map.update_occplane();
  set_normals(map, random);
}

/// Depth images of a ball and a box-shaped floor, from random places, integrated ray by ray.
inline void fill_with_scans(VoxelMap& map, Random& random) {
  const double length = map.grid().length;
  const Vec3 center = map.enclosure_center();
  const double radius = length * random.uniform(1, 4);
  const double floor_height = center.z() - length * random.uniform(1, 4);
  const int scans = 1 + random.index(3);
  for (int scan = 0; scan < scans; ++scan) {
    const View view = view_towards(center + length * random.uniform(15, 40) * random.unit_vector(), center);
    RangeImage image{camera_from_apertures(radians(50), radians(40), {28, 24}), {}};
    image.camera.max_depth = 60 * length;
    const RayGrid rays = image.camera.rays();
    for (int row = 0; row < 24; ++row) {
      for (int column = 0; column < 28; ++column) {
        const Vec3 d = view.world_from_sensor.linear() * Vec3(rays.x(column), rays.y(row), 1);
        const Vec3 o = view.position() - center;
        double depth = image.camera.max_depth;
        const double b = o.dot(d), a = d.squaredNorm();
        const double discriminant = b * b - a * (o.squaredNorm() - radius * radius);
        if (discriminant > 0) depth = std::min(depth, (-b - std::sqrt(discriminant)) / a);
        const double to_floor = (floor_height - view.position().z()) / d.z();
        if (to_floor > 0) depth = std::min(depth, to_floor);
        const bool is_unknown = random.uniform() < 0.03;
        const bool is_hit = depth < image.camera.max_depth;
        image.depth.push_back(is_unknown ? RangeImage::unknown
                                         : (is_hit ? static_cast<float>(depth) : RangeImage::no_return));
      }
    }
    integrate_exactly(map, sight_lines(image, range_image_normals(image), view));
  }
}

inline VoxelMap random_map(Random& random, MapKind kind) {
  VoxelMap map = unmarked_map(random);
  switch (kind) {
    case MapKind::noise:
      fill_with_noise(map, random);
      break;
    case MapKind::blobs:
      fill_with_blobs(map, random);
      break;
    case MapKind::scans:
      fill_with_scans(map, random);
      break;
  }
  return map;
}

/// Where a random camera stands.
enum class Stand { outside, inside, lattice, grazing };
inline constexpr Stand stands[] = {Stand::outside, Stand::inside, Stand::lattice, Stand::grazing};

inline Vec3 random_position(const VoxelMap& map, Random& random, Stand stand) {
  const Grid& grid = map.grid();
  const Box3 box = grid.box(map.enclosure());
  const Vec3 center = box.center();
  switch (stand) {
    case Stand::outside:
      return center + (0.5 * box.diagonal().norm() + grid.length * random.uniform(0.5, 60)) * random.unit_vector();
    case Stand::inside:
      return box.min() + Vec3(random.uniform(), random.uniform(), random.uniform()).cwiseProduct(box.diagonal());
    case Stand::lattice: {  // on one to three lattice planes, inside or outside
      Vec3 position;
      for (int a = 0; a < 3; ++a) {
        const int k = map.enclosure().min[a] - 12 + random.index(map.enclosure().size()[a] + 25);
        const double halves = one_of<double>(random, {0, 0, 0.5, random.uniform()});
        position[a] = halves == 0 ? grid.plane(a, k) : grid.plane(a, k) + halves * grid.length;
      }
      return position;
    }
    case Stand::grazing: {  // level with a face of the enclosure
      Vec3 position = center + grid.length * random.uniform(10, 40) * random.unit_vector();
      const int a = random.index(3);
      position[a] = (random.uniform() < 0.5 ? box.min()[a] : box.max()[a]) +
                    grid.length * one_of<double>(random, {0, 1e-12, -1e-12, 1e-7, -1e-7, 0.01, -0.01});
      return position;
    }
  }
  return center;
}

/// The sensor's axes along the world's, in one of the 24 orientations.
inline Mat3 axis_parallel(Random& random) {
  const int right = random.index(3);
  const int down = (right + 1 + random.index(2)) % 3;
  const Vec3 x = (random.uniform() < 0.5 ? 1 : -1) * Vec3::Unit(right);
  const Vec3 y = (random.uniform() < 0.5 ? 1 : -1) * Vec3::Unit(down);
  Mat3 rotation;
  rotation << x, y, x.cross(y);
  return rotation;
}

inline View random_view(const VoxelMap& map, Random& random, Stand stand) {
  View view;
  const Vec3 position = random_position(map, random, stand);
  const Box3 box = map.grid().box(map.enclosure());
  const Vec3 target =
      random.uniform() < 0.5
          ? Vec3(box.center())
          : Vec3(box.min() + Vec3(random.uniform(), random.uniform(), random.uniform()).cwiseProduct(box.diagonal()));
  const double choice = random.uniform();
  if (choice < 0.5 && (target - position).norm() > 1e-6) {
    view = view_towards(position, target);
  } else if (choice < 0.9) {
    // Of the axis-parallel looks take one that has the enclosure before it.
    Mat3 rotation = axis_parallel(random);
    for (int i = 0; i < 20 && rotation.col(2).dot(target - position) < 0.6 * (target - position).norm(); ++i) {
      rotation = axis_parallel(random);
    }
    const double tilt = one_of<double>(random, {0, 0, 1e-13, 1e-9, 1e-5, 1e-3, 0.03});
    view.world_from_sensor.linear() = Eigen::AngleAxisd(tilt, random.unit_vector()).toRotationMatrix() * rotation;
  } else {
    view.world_from_sensor.linear() =
        Eigen::AngleAxisd(random.uniform(0, 2 * std::numbers::pi), random.unit_vector()).toRotationMatrix();
  }
  view.world_from_sensor.translation() = position;
  return view;
}

/// A sensor whose frame is about as large as the enclosure looks from `view`, or anything else.
inline RangeCamera random_camera(const VoxelMap& map, const View& view, Random& random) {
  const Box3 box = map.grid().box(map.enclosure());
  const double distance = std::max((view.position() - box.center()).norm(), 2 * map.grid().length);
  const double tangent = std::min(4.0, 0.5 * box.diagonal().norm() / distance) * random.uniform(0.4, 1.5);
  RangeCamera camera;
  camera.left = -tangent;
  camera.right = tangent * random.uniform(0.7, 1.4);
  camera.top = -tangent * random.uniform(0.7, 1.4);
  camera.bottom = tangent;
  if (random.uniform() < 0.3) camera.right = -camera.left, camera.top = -camera.bottom;  // odd grids: a ray on the axis
  if (random.uniform() < 0.1) camera.left = random.uniform(-1, 0) * tangent, camera.right = camera.left + tangent;
  camera.min_depth = 0;
  camera.max_depth = 1000 * map.grid().length + distance;
  if (random.uniform() < 0.25) camera.min_depth = distance * random.uniform(0.2, 1);
  if (random.uniform() < 0.25) camera.max_depth = camera.min_depth + distance * random.uniform(0.5, 1.5);
  if (random.uniform() < 0.25) camera.max_incidence = random.uniform(0.2, 1.5);
  return camera;
}

inline Resolution random_resolution(Random& random) {
  const double choice = random.uniform();
  if (choice < 0.05) return {1, 1};
  if (choice < 0.15) return {1 + random.index(60), 1 + random.index(4)};
  if (choice < 0.25) return {1 + random.index(4), 1 + random.index(60)};
  if (choice < 0.35) return {33 + 2 * random.index(40), 33 + 2 * random.index(40)};
  return {5 + random.index(30), 5 + random.index(30)};
}

}  // namespace vantage::test
