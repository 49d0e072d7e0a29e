#include "vantage/model/scan_model.hpp"

#include <cmath>
#include <limits>

namespace vantage {
namespace {

int candidate_at(const Candidates& candidates, const View& view) {
  constexpr double near = 0.01;  // of the distance to the center
  const double least_cosine = std::cos(radians(1));
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < candidates.views.size(); ++i) {
    const View& candidate = candidates.views[i];
    const double distance = (candidate.position() - view.position()).norm();
    if (distance >= least || distance > near * (candidate.position() - candidates.center).norm()) continue;
    if (candidate.axis().dot(view.axis()) < least_cosine) continue;
    least = distance;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

}  // namespace

std::unique_ptr<Registrar> make_registrar(const ScanPlanOptions& options, const ScanScene& scene) {
  if (options.registration == "none") return std::make_unique<TrustingRegistrar>();
  // The largest errors that the user knows of are three standard deviations.
  RegistrarOptions registrar;
  registrar.error = std::make_shared<ConstantError>(PoseError::from_deviations(
      Vec3::Constant(options.pose_error / 3), Vec3::Constant(radians(options.pose_angle_error) / 3)));
  registrar.sensor = scene.sensor.given();
  // In front of real sensors hands and cables move through the box, and things shine.
  registrar.registration.outlier_share = 0.03;
  registrar.region = scene.region;
  // The box itself: the region less its surroundings, in which the robot may be seen to move.
  const double longest = scene.region.sizes().maxCoeff() / (1 + 2 * options.surroundings);
  const Vec3 around = Vec3::Constant(options.surroundings * longest);
  registrar.registration.still = Box3(scene.region.min() + around, scene.region.max() - around);
  return std::make_unique<IcpRegistrar>(registrar);
}

ScanModel::ScanModel(const ScanScene& scene)
    : model_(scene.scene, scene.scene.voxel_length / 4), center_(scene.scene.center), cleaner_(scene.sensor) {}

const ScanRecord& ScanModel::add(const ScanOrigin& origin, const Scan& measured, const View& believed,
                                 Registrar& registrar) {
  const ScanCleaner::Result cleaned = cleaner_.clean(measured);
  const Scan& scan = cleaned.scan ? *cleaned.scan : measured;
  model_.sensor = cleaner_.sensor().value_or(SensorModel());
  ScanRecord record = update(model_, scan, believed, registrar);
  record.flying = cleaned.flying;
  record.candidate = origin.candidate;
  record.commanded = origin.commanded.value_or(believed);
  record.reason = origin.name;
  const Vec3 position = sensor_position(scan, record.registered);
  record.distance = model_.scans.empty() ? 0 : model_.scans.back().distance + (position - current_.position()).norm();
  // A scan that was not merged may lie anywhere, as far as anybody knows: it says nothing about where to look from.
  if (record.merged) distances_.push_back((position - center_).norm());
  current_ = record.registered;
  current_.world_from_sensor.translation() = position;
  if (origin.commanded) with_command_.insert(record.scan);
  if (learner) {
    std::vector<const ScanRecord*> lessons{&record};
    for (const int number : record.recovered) lessons.push_back(&model_.scans[static_cast<std::size_t>(number)]);
    for (const ScanRecord* lesson : lessons) {
      if (with_command_.contains(lesson->scan)) (void)teach(*learner, *lesson);
    }
    record.learned_error = learner->estimate();
  }
  model_.scans.push_back(std::move(record));
  return model_.scans.back();
}

void tell_of_scans(Planner& planner, std::span<const ScanRecord> scans) {
  for (const ScanRecord& scan : scans) {
    if (!scan.merged) continue;
    planner.scanned(scan.registered,
                    scan.candidate >= 0 ? scan.candidate : candidate_at(planner.candidates(), scan.registered));
  }
}

}  // namespace vantage
