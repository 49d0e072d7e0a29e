#include "vantage/report/run_scene.hpp"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// The pose that the map was given, or else where the robot believed to be.
const View& place_of(const ScanRecord& scan) { return scan.merged ? scan.registered : scan.believed; }

/// The mean distance of the scans from what they look at; cameras are drawn in proportion.
double mean_distance(const ReportData& data, const Vec3& center) {
  double sum = 0;
  for (const ScanRecord& scan : data.scans) sum += (place_of(scan).position() - center).norm();
  return data.scans.empty() ? 1 : sum / static_cast<double>(data.scans.size());
}

}  // namespace

PictureScene model_scene(const ReportData& data) {
  PictureScene scene;
  if (data.mesh != nullptr && !data.mesh->triangles.empty()) {
    add_mesh(scene, *data.mesh, palette::clay);
  } else if (data.cloud != nullptr && data.cloud->size() > 0) {
    const double voxel = data.map != nullptr ? data.map->grid().length : 0.02;
    add_cloud(scene, *data.cloud, 0.32 * voxel, palette::clay);
  } else if (data.map != nullptr) {
    const VoxelMap& map = *data.map;
    add_voxels(scene, map, [&map](const Index3& voxel) {
      return map.label(voxel) == Label::occupied ? std::optional(palette::clay) : std::nullopt;
    });
  }
  return scene;
}

PictureScene views_scene(const ReportData& data) {
  PictureScene scene = model_scene(data);
  const Vec3 center = data.map != nullptr ? data.map->enclosure_center() : data.candidates.center;
  const double distance = mean_distance(data, center);
  std::vector<bool> taken(data.candidates.views.size());
  for (const ScanRecord& scan : data.scans)
    if (scan.candidate >= 0 && static_cast<std::size_t>(scan.candidate) < taken.size())
      taken[static_cast<std::size_t>(scan.candidate)] = true;
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (!taken[i]) scene.dots.push_back({data.candidates.views[i].position().cast<float>(), 1.7F, color(0xAEB5BF)});
  const bool sphere = data.candidates.kind == Candidates::Kind::sphere;
  const Vec3* before = nullptr;
  std::vector<Vec3> places;
  places.reserve(data.scans.size());
  for (const ScanRecord& scan : data.scans) {
    const View& view = place_of(scan);
    const Color paint = scan.merged ? palette::blue : palette::no_value;
    places.push_back(view.position());
    add_camera(scene, view, data.camera, 0.1 * distance, paint);
    const std::vector<Vec3> straight{before != nullptr ? *before : places.back(), places.back()};
    if (before != nullptr)
      add_path(scene, sphere ? arc(*before, places.back(), center) : straight, 2.2, palette::vermillion);
    before = &places.back();
    // Numbered as the page does it: the first scan is 1.
    scene.badges.push_back({center + 1.09 * (places.back() - center), scan.scan + 1, paint});
  }
  return scene;
}

std::optional<double> floor_under(const PictureScene& scene, const Vec3& up) {
  std::optional<double> lowest;
  const Vec3 z = up.normalized();
  const auto take = [&](const Vec3f& point) {
    const double height = point.cast<double>().dot(z);
    lowest = lowest ? std::min(*lowest, height) : height;
  };
  for (const PictureScene::Facet& facet : scene.facets)
    if (facet.finish != PictureScene::Finish::marker)
      for (const Vec3f& corner : facet.corner) take(corner);
  for (const PictureScene::Disc& disc : scene.discs) take(disc.center);
  return lowest;
}

Vec3 side_of(const Vec3& up, double turn, double rise) {
  const Vec3 z = up.normalized();
  Vec3 front = -Vec3::UnitY() + Vec3::UnitY().dot(z) * z;
  if (front.norm() < 0.5) front = Vec3::UnitZ() - Vec3::UnitZ().dot(z) * z;  // `up` is about y
  front.normalize();
  const Vec3 right = z.cross(front);
  const double a = radians(turn), b = radians(rise);
  return std::cos(b) * (std::cos(a) * front + std::sin(a) * right) + std::sin(b) * z;
}

}  // namespace vantage
