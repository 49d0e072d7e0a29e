// The same planner for a robot on a table: it must stay above the table top and inside its workspace, and its body must
// not touch anything that is not known to be empty. Every candidate that falls out says why.
// Links vantage::core only.

#include <cstdio>

#include "vantage/planning/planner.hpp"

using namespace vantage;

int main() {
  VoxelMap map(
      SceneOptions{.voxel_length = 0.02, .scene_size = Index3::Constant(101), .enclosure_size = Index3::Constant(21)});
  const RangeCamera camera = camera_from_apertures(radians(58), radians(45), {160, 120});
  const Candidates candidates = view_sphere(80, 0.6, map.enclosure_center());

  PlannerOptions options;
  options.reach.body_radius = 0.08;
  // The arm reaches no farther than y = -0.4; the table is solid down to the floor.
  options.reach.workspace = Box3(Vec3(-0.8, -0.4, -1), Vec3(0.8, 1, 1));
  options.reach.obstacles = {Box3(Vec3(-1, -1, -1), Vec3(1, 1, -0.21))};
  Planner planner(candidates, camera, options);

  // In place of a first scan: something hides a corner of the enclosure.
  map.set_label(map.enclosure().min, Label::occluded);
  map.update_occplane();
  const auto plan = planner.next_best_view(map, candidates.views.front());
  if (!plan) {
    std::printf("no view: %s\n", planner.why_finished().c_str());
    return 1;
  }
  std::printf("%zu views are feasible, %zu are not; next is view %d\n", plan->ranking.size(), plan->infeasible.size(),
              plan->best.candidate);
  for (const Evaluation& evaluation : plan->infeasible) {
    const Vec3 p = evaluation.view.position();
    std::printf("  view %2d at (%5.2f, %5.2f, %5.2f): %s\n", evaluation.candidate, p.x(), p.y(), p.z(),
                evaluation.reason.c_str());
  }
  const bool is_above_table = plan->best.view.position().z() > -0.21 + options.reach.body_radius;
  return is_above_table ? 0 : 1;
}
