// Peak memory of the paper's finest scene in a program that links nothing but vantage::core: a map of 405^3 voxels with
// an enclosure of 109^3, four scans, and 1,280 views of 320 x 320 rays. Ends with 1 beyond 150 MB.
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "support/analytic_scene.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/map/integrate.hpp"
#include "vantage/visibility/visibility.hpp"

namespace {

using namespace vantage;

constexpr double limit_in_megabytes = 150;

/// The most memory that this process ever held, code and stacks included: no less than its heap. -1 where unknown.
double peak_megabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    std::string key;
    double kilobytes = 0;
    if (words >> key >> kilobytes && key == "VmHWM:") return kilobytes * 1024 / 1e6;
  }
  return -1;
}

VoxelMap scanned_map(const RangeCamera& camera) {
  SceneOptions options;
  options.voxel_length = 4.1 / 405;
  options.scene_size = Index3::Constant(405);
  options.enclosure_size = Index3::Constant(109);
  VoxelMap map(options);
  const test::AnalyticScene objects{{{Vec3(0.1, 0, 0), 0.3}, {Vec3(-0.25, 0.1, 0.1), 0.2}},
                                    {Box3(Vec3(-0.4, -0.3, -0.35), Vec3(0.4, 0.3, -0.25))}};
  for (const Vec3& direction : {Vec3(1, 0.3, 0.4), Vec3(-0.5, 0.9, 0.5), Vec3(-0.6, -0.8, 0.3), Vec3(0.2, -0.3, 1)}) {
    const View view = view_towards(2 * direction.normalized(), Vec3::Zero());
    const RangeImage image = objects.scan(camera, view);
    integrate(map, image, range_image_normals(image), view);
  }
  return map;
}

}  // namespace

int main() {
  const RangeCamera camera;
  const VoxelMap map = scanned_map(camera);
  const std::vector<View> views = view_sphere(1280, 2, Vec3::Zero()).views;
  const std::vector<Visibility> seen = VisibilityEvaluator(map).see(camera, views, std::span(&camera.resolution, 1));
  std::int64_t voxels = 0;
  for (const Visibility& one : seen) voxels += one.occupied + one.occplane + one.unmarked;
  const double peak = peak_megabytes();
  std::cout << seen.size() << " views see " << voxels << " voxels of " << map.count(Label::occupied)
            << " occupied ones and others; peak memory " << peak << " MB, must be at most " << limit_in_megabytes
            << '\n';
  if (peak < 0) {
    std::cout << "skipped: /proc/self/status does not tell the peak memory\n";
    return 77;
  }
  return voxels > 0 && peak <= limit_in_megabytes ? 0 : 1;
}
