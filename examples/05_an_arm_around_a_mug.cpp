// An arm with six joints plans twenty views around a mug on a table: 05_an_arm_around_a_mug [ARM.yaml [FOLDER]]. It
// does so twice, once with moves counted by the path of the joints and once by utility alone, and writes the moves and
// the true scene to FOLDER where one is given.

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "vantage/model/reconstruction.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/simulation/mesh_tools.hpp"
#include "vantage/simulation/objects.hpp"
#include "vantage/simulation/simulated_robot.hpp"

using namespace vantage;

namespace {

constexpr int planned_views = 20;

void add(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Index3& triangle : other.triangles) mesh.triangles.emplace_back(triangle + Index3::Constant(first));
}

TriangleMesh box_mesh(const Box3& box) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices.push_back(box.corner(static_cast<Box3::CornerType>(corner)));  // x is bit 0, y bit 1, z bit 2
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// The mug standing on the table top.
TriangleMesh true_scene(const ReconstructOptions& options) {
  TriangleMesh mug = centred_and_scaled(make_object("mug"), options.size.value_or(0.12));
  const Box3 table = options.reach_options().obstacles.front();
  const Vec3 foot(options.center.x(), options.center.y(), table.max().z() - mug.box().min().z());
  for (Vec3& vertex : mug.vertices) vertex += foot;
  TriangleMesh scene = box_mesh(table);
  add(scene, mug);
  return scene;
}

struct ArmTour {
  std::vector<Move> moves;
  std::vector<View> views;
  double travel = 0;  // radians of the joints
  std::int64_t occupied = 0;
};

ArmTour plan_views(const RangeScanner& scanner, const ReconstructOptions& options) {
  ObjectModel model(options.scene_options(), options.point_spacing());
  Planner planner(options.candidate_views(), options.range_camera(), options.planner_options());
  SimulatedRobot robot(scanner, options.range_camera(), {}, options.seed);
  TrustingRegistrar registrar;
  Reconstruction loop(robot, planner, registrar);
  loop.budget.max_views = 1 + planned_views;
  loop.budget.max_fruitless_scans = planned_views;
  ArmTour tour;
  loop.on_scan = [&tour](ScanRecord& record, const Scan&, const ObjectModel&, const Plan* plan) {
    tour.travel = record.distance;
    tour.occupied = record.labels.occupied;
    if (plan == nullptr) return;
    tour.moves.push_back(plan->move);
    tour.views.push_back(plan->best.view);
  };
  loop.run(model, options.initial_view);
  std::printf("%zu views planned and reached, %.2f rad of the joints, %lld occupied voxels (%s)\n", tour.moves.size(),
              tour.travel, static_cast<long long>(tour.occupied), loop.stop_reason().c_str());
  return tour;
}

void write_moves(const std::filesystem::path& path, const ArmTour& tour) {
  std::ofstream file(path);
  file.precision(17);
  for (std::size_t i = 0; i < tour.moves.size(); ++i) {
    for (const RobotState& state : tour.moves[i].path) {
      file << i << ' ' << tour.views[i].position().transpose() << ' ' << tour.views[i].axis().transpose() << ' '
           << state.joints.transpose() << '\n';
    }
  }
}

void write_scene(const std::filesystem::path& path, const TriangleMesh& mesh) {
  std::ofstream file(path);
  file.precision(17);
  file << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
  for (const Vec3& vertex : mesh.vertices) file << vertex.transpose() << '\n';
  for (const Index3& triangle : mesh.triangles) file << "3 " << triangle.transpose() << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  ReconstructOptions options;
  options.robot.emplace(argc > 1 ? argv[1] : "examples/arm.yaml");
  load_robot(options);
  options.camera = "14x11:160x120";  // so narrow that there is something new to see for more than twenty views
  const TriangleMesh scene = true_scene(options);
  const RangeScanner scanner(scene);

  std::printf("moves counted by the path of the joints: ");
  const ArmTour by_travel = plan_views(scanner, options);
  std::printf("by utility alone:                        ");
  options.navigation = false;
  const ArmTour by_utility = plan_views(scanner, options);
  if (argc > 2) {
    const std::filesystem::path folder(argv[2]);
    write_scene(folder / "scene.off", scene);
    write_moves(folder / "by_travel.txt", by_travel);
    write_moves(folder / "by_utility.txt", by_utility);
  }
  const bool all_planned = by_travel.moves.size() == planned_views && by_utility.moves.size() == planned_views;
  return all_planned && by_travel.travel < by_utility.travel ? 0 : 1;
}
