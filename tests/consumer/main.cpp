// Scans a plate once, plans the next view and checks that the plan makes sense.
#include <cstdio>
#include <vantage/map/integrate.hpp>
#include <vantage/planning/planner.hpp>

namespace {

using namespace vantage;

/// What a camera sees of a plate `depth` metres away that fills the middle of the image.
RangeImage plate(const RangeCamera& camera, float depth) {
  RangeImage image{camera,
                   std::vector<float>(static_cast<std::size_t>(camera.resolution.rays()), RangeImage::no_return)};
  const auto [columns, rows] = camera.resolution;
  for (int row = rows / 3; row < 2 * rows / 3; ++row) {
    for (int column = columns / 3; column < 2 * columns / 3; ++column) {
      image.depth[static_cast<std::size_t>(row * columns + column)] = depth;
    }
  }
  return image;
}

bool check(bool holds, const char* what) {
  std::printf("%s: %s\n", what, holds ? "yes" : "NO");
  return holds;
}

}  // namespace

int main() {
  VoxelMap map(
      SceneOptions{.voxel_length = 0.05, .scene_size = Index3::Constant(41), .enclosure_size = Index3::Constant(11)});
  const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {96, 96});
  const Candidates candidates = view_sphere(80, 1.0, map.enclosure_center());

  const View first = candidates.views.front();
  const RangeImage image = plate(camera, 1.0F);
  const auto report = integrate(map, image, range_image_normals(image), first);
  std::printf("%lld voxels occupied\n", static_cast<long long>(report.new_occupied));

  Planner planner(candidates, camera);
  const auto plan = planner.next_best_view(map, first);
  if (!check(plan.has_value(), "there is a next view")) return 1;
  std::printf("%s\n", plan->explanation.c_str());

  // The plate hides what is behind it, so the next view has to be another one that sees the border of the unknown.
  const bool sees_occplane = check(plan->best.seen.occplane > 0, "it sees occlusion planes");
  const bool moves = check((plan->best.view.position() - first.position()).norm() > 0.1, "it is another view");
  return report.new_occupied > 0 && sees_occplane && moves ? 0 : 1;
}
