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

constexpr double trust_in_robots = 0.01;
constexpr double certain_orientation = radians(0.1);

/// What registration has to search through where the sensor may be turned too: the surface then lies off by the angle
/// times its distance.
RegistrationOptions registration_options(const ReconstructOptions& options, const View& typical) {
  RegistrationOptions result;
  const PoseError error = options.robot_error(options.center)->of_move(typical, typical);
  const PoseError::Vector deviations = error.covariance.diagonal().cwiseSqrt() + error.mean.cwiseAbs();
  if (!error.keeps_orientation()) {
    const double angle = deviations.tail<3>().maxCoeff();
    const double distance = (typical.position() - options.center).norm();
    result.orientation_error = std::max(result.orientation_error, angle);
    result.search_radius = 3 * std::hypot(deviations.head<3>().maxCoeff(), angle * distance);
  }
  if (!options.sensor_model().is_ideal()) {
    // As for real frames, which are noisy too: the robot's word decides where noise leaves a direction weakly held.
    result.trust = trust_in_robots;
    result.trust_at_last = 0;
    if (error.keeps_orientation()) result.orientation_error = certain_orientation;
    if (!result.search_radius) result.search_radius = 3 * deviations.head<3>().maxCoeff();
  }
  return result;
}

std::unique_ptr<Registrar> make_registrar(const ReconstructOptions& options, const SimulatedRobot& robot) {
  if (options.registration == "truth") {
    return std::make_unique<TruthRegistrar>([&robot] { return robot.true_view(); });
  }
  if (options.registration == "none") return std::make_unique<TrustingRegistrar>();
  return std::make_unique<IcpRegistrar>(registration_options(options, options.candidate_views().views.front()));
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
                  utility ? *utility : utility_by_name(options.utility));
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
    record.coverage = object.truth().coverage(model.map);
    record.coverage_all = object.truth().coverage_all(model.map);
    observer.on_scan(record, scan, model, plan);
  };
  loop.run(run.model, options.initial_view);
  run.stop_reason = loop.stop_reason();
  return run;
}

}  // namespace vantage
