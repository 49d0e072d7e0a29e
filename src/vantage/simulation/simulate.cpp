#include "vantage/simulation/simulate.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

TriangleMesh placed(const TriangleMesh& mesh, double size, const Vec3& center) {
  TriangleMesh object = centred_and_scaled(mesh, size);
  for (Vec3& vertex : object.vertices) vertex += center;
  return object;
}

std::unique_ptr<Registrar> make_registrar(const ReconstructOptions& options, const SimulatedRobot& robot) {
  if (options.registration == "truth") {
    return std::make_unique<TruthRegistrar>([&robot] { return robot.true_view(); });
  }
  if (options.registration == "none") return std::make_unique<TrustingRegistrar>();
  RegistrarOptions registrar;
  if (auto error = options.believed_error_model(options.center)) {
    registrar.error = std::move(error);
  } else {
    registrar.error = std::make_shared<ConstantError>(PoseError());
  }
  registrar.sensor = options.sensor_model();
  registrar.first_is_exact = simulated_robot_options(options).first_pose_exact;
  return std::make_unique<IcpRegistrar>(registrar);
}

/// How far the scan's points are off in the mean where it counts as taken from `registered`, metres.
double mean_displacement(const PointCloud& points, const View& registered, const View& truth) {
  double sum = 0;
  for (const Vec3& point : points.points)
    sum += (registered.world_from_sensor * point - truth.world_from_sensor * point).norm();
  return points.size() == 0 ? (registered.position() - truth.position()).norm()
                            : sum / static_cast<double>(points.size());
}

}  // namespace

SimulatedRobotOptions simulated_robot_options(const ReconstructOptions& options) {
  return {.error = options.robot_error(options.center),
          .first_pose_exact = options.registration == "icp",
          .sensor = options.sensor_model(),
          .flying_pixels = options.flying_pixels};
}

SimulatedObject::SimulatedObject(const TriangleMesh& mesh, double size, const ReconstructOptions& options)
    : scanner_(std::make_unique<RangeScanner>(placed(mesh, size, options.center))) {
  const SceneOptions scene = options.scene_options();
  truth_ = std::make_unique<GroundTruth>(*scanner_, scene.grid(), scene.enclosure(), options.range_camera(),
                                         visibility_views(options.candidate_views()));
}

SimulatedRun simulate(const SimulatedObject& object, const ReconstructOptions& options, const RunObserver& observer,
                      const std::optional<Utility>& utility) {
  options.validate();
  require(!options.robot || options.robot_model, "robot = '", options.robot.value_or(""),
          "': the file has not been read; call load_robot first");
  SimulatedRun run{ObjectModel(options.scene_options(), options.point_spacing()), {}};
  run.model.sensor = options.sensor_model();
  Planner planner(options.candidate_views(), options.range_camera(), options.planner_options(),
                  utility ? *utility : options.planner_options().make_utility());
  const ReachOptions reach = options.planner_options().reach;
  SimulatedRobot robot(object.scanner(), options.range_camera(), simulated_robot_options(options), options.seed,
                       [&](const View& view) { return !why_infeasible(run.model.map, view, reach); });
  const std::unique_ptr<Registrar> registrar = make_registrar(options, robot);

  Reconstruction loop(robot, planner, *registrar);
  loop.budget = options.budget();
  loop.quality = options.quality_reference();
  if (const auto learner = options.learner_options()) loop.learner.emplace(*learner);
  loop.interrupted = observer.interrupted;
  loop.on_plan = observer.on_plan;
  loop.on_scan = [&](ScanRecord& record, const Scan& scan, const ObjectModel& model, const Plan* plan) {
    record.true_view = robot.true_view();
    record.pose_error = mean_displacement(points_of(scan), record.registered, *record.true_view);
    record.coverage = object.truth().coverage(model.map);
    record.coverage_all = object.truth().coverage_all(model.map);
    observer.on_scan(record, scan, model, plan);
  };
  loop.on_end = [&](ObjectModel& model) {
    for (ScanRecord& record : model.scans) {
      if (const auto kept = model.kept.find(record.scan); kept != model.kept.end())
        record.pose_error = mean_displacement(points_of(kept->second.scan()), record.registered, *record.true_view);
    }
    model.scans.back().coverage = object.truth().coverage(model.map);
    model.scans.back().coverage_all = object.truth().coverage_all(model.map);
  };
  loop.run(run.model, options.initial_view);
  run.stop_reason = loop.stop_reason();
  return run;
}

}  // namespace vantage
