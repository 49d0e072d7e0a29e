#include "vantage/robot/error_model.hpp"

#include "vantage/core/error.hpp"
#include "vantage/robot/error_limits.hpp"

namespace vantage {

GrowingError::GrowingError(const PoseError& base, const PoseError::Vector& deviation_per_metre)
    : base_(base), per_metre_(deviation_per_metre) {
  base_.validate();
  require(PoseError::Matrix(base_.covariance.diagonal().asDiagonal()) == base_.covariance,
          "growing error: the covariance at distance 0 has entries off its diagonal; the deviations a + b d need "
          "independent axes");
  constexpr double largest = 1e3;  // a robot that ends up a thousand times as far off as it moved
  require(per_metre_.allFinite() && (per_metre_.array() >= 0).all() && (per_metre_.array() <= largest).all(),
          "growing error: deviations per metre ", per_metre_.transpose(), ": must be from 0 to ", largest);
}

PoseError GrowingError::of_move(const View& from, const View& to) const {
  const double distance = (to.position() - from.position()).norm();
  PoseError error = base_;
  const PoseError::Vector deviations = base_.covariance.diagonal().cwiseSqrt() + distance * per_metre_;
  error.covariance = deviations.cwiseAbs2().asDiagonal();
  return error;
}

TurntableArmError::TurntableArmError(const Deviations& deviations, const Vec3& center)
    : deviations_(deviations), center_(center) {
  for (const auto& [name, value] :
       {std::pair{"azimuth", deviations.azimuth}, {"elevation", deviations.elevation}, {"reach", deviations.reach}}) {
    require(value >= 0 && value <= largest_position_error, "turntable error: deviation of the ", name, " = ", value,
            ": must be from 0 to ", largest_position_error);
  }
}

PoseError TurntableArmError::of_move(const View& /*from*/, const View& to) const {
  const Vec3 arm = to.position() - center_;
  const Mat3 sensor_from_world = to.world_from_sensor.linear().transpose();
  // The arm's own axis lies level across it; straight above the table it is where azimuth 0 would put it.
  const Vec3 across = Vec3::UnitZ().cross(arm);
  const Vec3 axis_of_elevation = across.norm() > 1e-9 ? Vec3(across.normalized()) : Vec3(Vec3::UnitY());
  // Turning by dw about an axis through the center moves the sensor by dw x arm and turns it by dw.
  Eigen::Matrix<double, 6, 3> effect = Eigen::Matrix<double, 6, 3>::Zero();
  const auto put_turn = [&](int column, const Vec3& axis, double deviation) {
    const Vec3 turn_in_sensor = sensor_from_world * axis;
    effect.col(column) << axis.cross(arm), turn_in_sensor.y(), turn_in_sensor.x(), turn_in_sensor.z();
    effect.col(column) *= deviation;
  };
  put_turn(0, Vec3::UnitZ(), deviations_.azimuth);
  put_turn(1, axis_of_elevation, deviations_.elevation);
  if (arm.norm() > 0) effect.col(2).head<3>() = deviations_.reach * arm.normalized();
  PoseError error;
  error.covariance = effect * effect.transpose();
  return error;
}

}  // namespace vantage
