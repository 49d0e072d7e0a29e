#include "vantage/model/registrar.hpp"

namespace vantage {
namespace {

ScanSurface whole_surface(const Scan& scan, const PointCloud& points, const std::optional<SensorModel>& sensor) {
  if (const auto* image = std::get_if<ImageScan>(&scan)) return scan_surface(image->image, sensor);
  const auto& lines = std::get<PointScan>(scan);
  const std::vector<Vec3> own_place{Vec3::Zero()};
  return scan_surface(points, lines.origins.empty() ? own_place : lines.origins, sensor);
}

}  // namespace

PoseError usual_pose_error() {
  return PoseError::from_deviations(Vec3::Constant(0.05 / 3), Vec3::Constant(radians(5) / 3));
}

PoseEstimate pose_estimate(const View& commanded, const PoseError& error) {
  const View expected = displaced(commanded, error.mean);
  // Pan, tilt and roll turn about the sensor's y, x and z; the step's rotation vector is in the world.
  Mat6 step_of_error = Mat6::Zero();
  step_of_error.topLeftCorner<3, 3>().setIdentity();
  const Mat3 axes = expected.world_from_sensor.linear();
  step_of_error.col(3).tail<3>() = axes.col(1);
  step_of_error.col(4).tail<3>() = axes.col(0);
  step_of_error.col(5).tail<3>() = axes.col(2);
  const Mat6 covariance = step_of_error * error.covariance * step_of_error.transpose();
  return {expected.world_from_sensor, 0.5 * (covariance + covariance.transpose())};
}

IcpRegistrar::IcpRegistrar(RegistrarOptions options) : options_(std::move(options)) {
  options_.registration.validate();
  if (options_.sensor) options_.sensor->validate();
}

void IcpRegistrar::believe(const PoseError& error) { options_.error = std::make_shared<ConstantError>(error); }

std::shared_ptr<const ScanSurface> IcpRegistrar::surface_of(const Scan& scan, const PointCloud& points,
                                                            const View& believed) const {
  auto surface = std::make_shared<ScanSurface>(whole_surface(scan, points, options_.sensor));
  if (options_.region) {
    std::erase_if(surface->samples, [&](const SurfaceSample& sample) {
      return !options_.region->contains(believed.world_from_sensor * sample.point);
    });
  }
  return surface;
}

PoseEstimate IcpRegistrar::prior(const ModelSurface& model, const View& believed) {
  const View from = last_.value_or(believed);
  last_ = believed;
  const PoseEstimate expected = pose_estimate(believed, options_.error->of_move(from, believed));
  if (model.cloud().size() > 0) return expected;
  // The first scan defines the frame of the model.
  return {believed.world_from_sensor, options_.first_is_exact ? Mat6::Zero() : expected.covariance};
}

Located IcpRegistrar::locate(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                             const View& believed) {
  if (model.cloud().size() > 0) return locate_from(model, scan, points, prior(model, believed));
  Located located{.view = believed, .verdict = "first", .detail = "the first scan defines the frame"};
  located.surface = surface_of(scan, points, believed);
  return located;
}

Located IcpRegistrar::locate_from(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                                  const PoseEstimate& known) {
  Located located;
  located.surface = surface_of(scan, points, View{known.mean});
  const Registration found = register_scan(model.registered(), *located.surface, known, options_.registration);
  located.view = View{found.world_from_sensor};
  located.accepted = found.succeeded();
  located.overlap = found.overlap;
  located.residual = found.residual;
  located.verdict = name(found.verdict);
  located.detail = found.explanation;
  located.covariance = found.covariance;
  located.undetermined_directions = found.undetermined_directions;
  located.value = found.value;
  located.limit = found.limit;
  return located;
}

}  // namespace vantage
