#include "vantage/report/picture_scene.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/report/label_colors.hpp"

namespace vantage {
namespace {

constexpr double crease_cosine = 0.7071;  // edges sharper than 45 degrees stay sharp

/// The triangles at each vertex, one list after the other.
struct Fans {
  std::vector<std::size_t> first;  // per vertex, and the end
  std::vector<std::size_t> triangle;
};

Fans fans_of(const TriangleMesh& mesh) {
  Fans fans;
  fans.first.assign(mesh.vertices.size() + 1, 0);
  for (const Index3& corners : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++fans.first[static_cast<std::size_t>(corners[k]) + 1];
  for (std::size_t v = 1; v < fans.first.size(); ++v) fans.first[v] += fans.first[v - 1];
  fans.triangle.resize(fans.first.back());
  std::vector<std::size_t> next(fans.first.begin(), fans.first.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) fans.triangle[next[static_cast<std::size_t>(mesh.triangles[t][k])]++] = t;
  return fans;
}

Vec3f unit(const Vec3& direction) {
  const double length = direction.norm();
  return length > 0 ? Vec3f((direction / length).cast<float>()) : Vec3f::Zero();
}

void add_marker(PictureScene& scene, const Vec3& a, const Vec3& b, const Vec3& c, const Color& color) {
  const Vec3f normal = unit((b - a).cross(c - a));
  scene.facets.push_back({{a.cast<float>(), b.cast<float>(), c.cast<float>()},
                          {normal, normal, normal},
                          color,
                          PictureScene::Finish::marker});
}

void add_stroke(PictureScene& scene, const Vec3& from, const Vec3& to, double width, const Color& color) {
  scene.strokes.push_back({from.cast<float>(), to.cast<float>(), static_cast<float>(width), color});
}

}  // namespace

Box3 PictureScene::solid_box() const {
  Box3 bounds;
  for (const Facet& facet : facets)
    if (facet.finish != Finish::marker)
      for (const Vec3f& corner : facet.corner) bounds.extend(corner.cast<double>());
  for (const Disc& disc : discs) bounds.extend(disc.center.cast<double>());
  return bounds;
}

std::vector<Vec3> PictureScene::points() const {
  std::vector<Vec3> all;
  all.reserve(3 * facets.size() + discs.size() + 2 * strokes.size() + dots.size() + badges.size());
  for (const Facet& facet : facets)
    for (const Vec3f& corner : facet.corner) all.push_back(corner.cast<double>());
  for (const Disc& disc : discs) all.push_back(disc.center.cast<double>());
  for (const Stroke& stroke : strokes) {
    all.push_back(stroke.from.cast<double>());
    all.push_back(stroke.to.cast<double>());
  }
  for (const Dot& dot : dots) all.push_back(dot.center.cast<double>());
  for (const Badge& badge : badges) all.push_back(badge.place);
  return all;
}

Box3 PictureScene::box() const {
  Box3 bounds;
  for (const Vec3& point : points()) bounds.extend(point);
  return bounds;
}

void add_mesh(PictureScene& scene, const TriangleMesh& mesh, const Color& color) {
  std::vector<Vec3> area_normals;
  area_normals.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    area_normals.push_back((mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0)));
  const Fans fans = fans_of(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (area_normals[t].squaredNorm() == 0) continue;
    PictureScene::Facet facet{{}, {}, color, PictureScene::Finish::solid};
    for (int k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(mesh.triangles[t][k]);
      Vec3 sum = Vec3::Zero();
      for (std::size_t i = fans.first[vertex]; i < fans.first[vertex + 1]; ++i) {
        const Vec3& other = area_normals[fans.triangle[i]];
        if (other.dot(area_normals[t]) >= crease_cosine * other.norm() * area_normals[t].norm()) sum += other;
      }
      facet.corner[static_cast<std::size_t>(k)] = mesh.vertices[vertex].cast<float>();
      facet.normal[static_cast<std::size_t>(k)] = unit(sum);
    }
    scene.facets.push_back(facet);
  }
}

void add_cloud(PictureScene& scene, const PointCloud& cloud, double radius, const Color& color) {
  scene.discs.reserve(scene.discs.size() + cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    scene.discs.push_back({cloud.points[i].cast<float>(), unit(cloud.normals[i]), static_cast<float>(radius), color});
}

VoxelPaint paint_labels(const VoxelMap& map) {
  return [&map](const Index3& voxel) -> std::optional<Color> {
    const Label label = map.label(voxel);
    if (label == Label::occupied) return palette::clay;
    if (label == Label::occplane) return label_color(label);
    return std::nullopt;
  };
}

VoxelPaint paint_quality(const VoxelMap& map) {
  return [&map](const Index3& voxel) -> std::optional<Color> {
    const SurfaceVoxel* surface = map.surface(voxel);
    if (surface == nullptr) return std::nullopt;
    return sequential_color(surface->quality);
  };
}

VoxelPaint paint_normals(const VoxelMap& map) {
  return [&map](const Index3& voxel) -> std::optional<Color> {
    const SurfaceVoxel* surface = map.surface(voxel);
    if (surface == nullptr) return std::nullopt;
    const Vec3 normal = surface->normal();
    if (normal.isZero()) return palette::no_value;
    const Vec3 channel = (normal + Vec3::Ones()) / 2;
    return Color{channel.x(), channel.y(), channel.z()};
  };
}

void add_voxels(PictureScene& scene, const VoxelMap& map, const VoxelPaint& paint) {
  const IndexBox& box = map.enclosure();
  const float length = static_cast<float>(map.grid().length);
  scene.lattice = map.grid();
  Index3 voxel;
  for (voxel.z() = box.min.z(); voxel.z() <= box.max.z(); ++voxel.z())
    for (voxel.y() = box.min.y(); voxel.y() <= box.max.y(); ++voxel.y())
      for (voxel.x() = box.min.x(); voxel.x() <= box.max.x(); ++voxel.x()) {
        const std::optional<Color> color = paint(voxel);
        if (!color) continue;
        const Vec3f corner = map.grid().corner(voxel).cast<float>();
        for (int axis = 0; axis < 3; ++axis)
          for (const int side : {0, 1}) {
            const Index3 neighbour = voxel + (side == 1 ? 1 : -1) * Index3::Unit(axis);
            if (box.contains(neighbour) && paint(neighbour)) continue;
            const Vec3f normal = (side == 1 ? 1.0F : -1.0F) * Vec3f::Unit(axis);
            const Vec3f a = corner + static_cast<float>(side) * length * Vec3f::Unit(axis);
            const Vec3f u = length * Vec3f::Unit((axis + 1) % 3), v = length * Vec3f::Unit((axis + 2) % 3);
            for (const auto& corners : {std::array<Vec3f, 3>{a, a + u, a + u + v}, {a, a + u + v, a + v}})
              scene.facets.push_back({corners, {normal, normal, normal}, *color, PictureScene::Finish::voxel});
          }
      }
}

void add_path(PictureScene& scene, std::span<const Vec3> points, double width, const Color& color) {
  for (std::size_t i = 1; i < points.size(); ++i) add_stroke(scene, points[i - 1], points[i], width, color);
}

void add_camera(PictureScene& scene, const View& view, const RangeCamera& camera, double length, const Color& color) {
  const Vec3 eye = view.position();
  const auto in_world = [&](double x, double y) -> Vec3 {
    return view.world_from_sensor * Vec3(Vec3(x, y, 1) * length);
  };
  const std::array<Vec3, 4> image{in_world(camera.left, camera.top), in_world(camera.right, camera.top),
                                  in_world(camera.right, camera.bottom), in_world(camera.left, camera.bottom)};
  const Color line = mix(color, palette::black, 0.45);
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3& next = image[(k + 1) % 4];
    add_marker(scene, eye, image[k], next, color);
    add_stroke(scene, eye, image[k], 1.2, line);
    add_stroke(scene, image[k], next, 1.2, line);
  }
  const Color front = mix(color, Color{1, 1, 1}, 0.55);  // the side that looks is lighter
  add_marker(scene, image[0], image[1], image[2], front);
  add_marker(scene, image[0], image[2], image[3], front);
}

void add_box(PictureScene& scene, const Box3& box, double width, const Color& color) {
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 4; ++k) {
      Vec3 from = box.min(), to = box.min();
      to[axis] = box.max()[axis];
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      if ((k & 1) != 0) from[u] = to[u] = box.max()[u];
      if ((k & 2) != 0) from[v] = to[v] = box.max()[v];
      add_stroke(scene, from, to, width, color);
    }
}

std::vector<Vec3> arc(const Vec3& from, const Vec3& to, const Vec3& center) {
  const Vec3 a = from - center, b = to - center;
  const double radius_a = a.norm(), radius_b = b.norm();
  if (radius_a == 0 || radius_b == 0) return {from, to};
  const Vec3 u = a / radius_a;
  const double angle = std::acos(std::clamp(u.dot(b / radius_b), -1.0, 1.0));
  Vec3 across = b / radius_b - std::cos(angle) * u;
  if (across.norm() < 1e-9) {  // the same direction, or the opposite one: any way round is as short
    if (angle < 1) return {from, to};
    across = u.unitOrthogonal();
  }
  across.normalize();
  const int steps = std::max(2, static_cast<int>(std::ceil(angle / radians(4))));
  std::vector<Vec3> points;
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const double radius = radius_a + (radius_b - radius_a) * share;
    points.push_back(center + radius * (std::cos(angle * share) * u + std::sin(angle * share) * across));
  }
  return points;
}

}  // namespace vantage
