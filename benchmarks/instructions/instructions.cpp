// Evaluates views and integrates scans of a small scene, for counting instructions: see check.py. One thread, no clock.
#include <tbb/global_control.h>

#include <iostream>

#include "support/analytic_scene.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/map/integrator.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage::test {

struct Scan {
  RangeImage image;
  std::vector<Vec3f> normals;
  View view;
};

std::vector<Scan> scans_of_two_balls(const RangeCamera& camera) {
  const AnalyticScene objects{{{Vec3(0.1, 0, 0), 0.2}, {Vec3(-0.15, 0.05, 0.05), 0.12}}, {}};
  std::vector<Scan> scans;
  for (const Vec3& direction : {Vec3(1, 0.3, 0.4), Vec3(-0.5, 0.9, 0.5), Vec3(-0.6, -0.8, 0.3)}) {
    const View view = view_towards(1.5 * direction.normalized(), Vec3::Zero());
    RangeImage image = objects.scan(camera, view);
    std::vector<Vec3f> normals = range_image_normals(image);
    scans.push_back({std::move(image), std::move(normals), view});
  }
  return scans;
}

// check.py counts the instructions within the functions whose names begin with "counted_".

[[gnu::noinline]] VoxelMap counted_integration(VoxelMap map, const std::vector<Scan>& scans) {
  Integrator integrator;
  for (const Scan& scan : scans) integrator.integrate(map, scan.image, scan.normals, scan.view);
  return map;
}

[[gnu::noinline]] std::vector<Visibility> counted_evaluation(const VoxelMap& map, const RangeCamera& camera,
                                                             const std::vector<View>& views) {
  // The path that every processor has, so that the counts are those of any machine.
  return VisibilityEvaluator(map, InstructionSet::portable).see(camera, views, std::span(&camera.resolution, 1));
}

}  // namespace vantage::test

int main() {
  using namespace vantage;
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  RangeCamera camera;
  camera.resolution = {160, 160};
  SceneOptions options;
  options.scene_size = Index3::Constant(101);
  options.enclosure_size = Index3::Constant(35);
  const VoxelMap map = test::counted_integration(VoxelMap(options), test::scans_of_two_balls(camera));
  const std::vector<View> views = view_sphere(20, 1.5, Vec3::Zero()).views;
  std::int64_t voxels = 0;
  for (const Visibility& seen : test::counted_evaluation(map, camera, views)) voxels += seen.occupied + seen.occplane;
  std::cout << voxels << " visible voxels\n";
  return voxels > 0 ? 0 : 1;
}
