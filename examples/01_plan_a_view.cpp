// The smallest program that plans: one scan goes in, the next best view comes out with the reasons.
// Links vantage::core only.

#include <cmath>
#include <cstdio>
#include <ranges>

#include "vantage/map/integrate.hpp"
#include "vantage/planning/planner.hpp"

using namespace vantage;

namespace {

/// What the camera would measure of a ball of `radius` at the origin. A real program asks its sensor instead.
RangeImage scan_ball(const RangeCamera& camera, const View& view, double radius) {
  RangeImage image{camera, {}};
  const RayGrid rays = camera.rays();
  for (int row = 0; row < camera.resolution.rows; ++row) {
    for (int column = 0; column < camera.resolution.columns; ++column) {
      const Vec3 direction = ray_direction(view.world_from_sensor.linear(), rays.x(column), rays.y(row));
      // |position + depth * direction| = radius, solved for the smaller depth.
      const double a = direction.squaredNorm();
      const double b = view.position().dot(direction);
      const double discriminant = b * b - a * (view.position().squaredNorm() - radius * radius);
      const double depth = (-b - std::sqrt(discriminant)) / a;
      image.depth.push_back(discriminant >= 0 ? static_cast<float>(depth) : RangeImage::no_return);
    }
  }
  return image;
}

}  // namespace

int main() {
  // 2 cm voxels; the object is known to lie in the central 0.82 m, the enclosure.
  VoxelMap map(
      SceneOptions{.voxel_length = 0.02, .scene_size = Index3::Constant(151), .enclosure_size = Index3::Constant(41)});
  const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {160, 160});
  const Candidates candidates = view_sphere(80, 1.4, map.enclosure_center());
  Planner planner(candidates, camera);

  View view = candidates.views.front();
  for (int scan = 1; scan <= 3; ++scan) {
    const RangeImage image = scan_ball(camera, view, 0.3);
    integrate(map, image, range_image_normals(image), view);
    std::printf("scan %d: %lld voxels occupied, %lld at the border of what is hidden\n", scan,
                static_cast<long long>(map.count(Label::occupied)), static_cast<long long>(map.count(Label::occplane)));

    const auto plan = planner.next_best_view(map, view);
    if (!plan) {
      std::printf("finished: %s\n", planner.why_finished().c_str());
      return 0;
    }
    std::printf("  next view %d: %s\n", plan->best.candidate, plan->explanation.c_str());
    for (const Evaluation& evaluation : plan->ranking | std::views::take(3)) {
      std::printf("    view %2d: area %.3f  navigation %.3f  quality %.3f  occlusion %.3f  utility %.3f\n",
                  evaluation.candidate, evaluation.factors.f_area, evaluation.factors.f_navigation,
                  evaluation.factors.f_quality, evaluation.factors.f_occlusion, evaluation.utility);
    }
    view = plan->best.view;
  }
}
