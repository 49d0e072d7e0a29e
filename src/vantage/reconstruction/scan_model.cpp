#include "vantage/reconstruction/scan_model.hpp"

namespace vantage {

std::unique_ptr<Registrar> make_registrar(const ScanPlanOptions& options, const ScanScene& scene) {
  if (options.registration == "none") return std::make_unique<TrustingRegistrar>();
  RegistrationOptions registration;
  // Real frames are noisy: surfels of two voxels average that out. And a robot's poses are good: what the surfaces
  // leave open stays as the robot says.
  registration.search_radius = options.pose_error;
  registration.orientation_error = radians(options.pose_angle_error) / 3;
  registration.spacing = scene.scene.voxel_length;
  registration.finest_cell_in_spacings = 2;
  registration.trust = 0.01;
  registration.largest_open_misfit = options.pose_error;
  registration.largest_share_in_free_space = 0.2;
  return std::make_unique<IcpRegistrar>(registration, scene.region);
}

ScanModel::ScanModel(const ScanScene& scene) : model_(scene.scene, scene.scene.voxel_length / 4) {}

const ScanRecord& ScanModel::add(const std::string& name, const Scan& scan, const View& believed,
                                 Registrar& registrar) {
  ScanRecord record = update(model_, scan, believed, registrar);
  record.commanded = believed;
  record.reason = name;
  const Vec3 position = sensor_position(scan, record.registered);
  record.distance = model_.scans.empty() ? 0 : model_.scans.back().distance + (position - current_.position()).norm();
  current_ = record.registered;
  current_.world_from_sensor.translation() = position;
  model_.scans.push_back(std::move(record));
  return model_.scans.back();
}

}  // namespace vantage
