#pragma once

#include <memory>

#include "vantage/robot/pose_error.hpp"

namespace vantage {

/// How a robot errs, move by move: what a robot model gives the planner, and the simulation the robot. Asked once per
/// candidate view.
class PoseErrorModel {
 public:
  PoseErrorModel() = default;
  PoseErrorModel(const PoseErrorModel&) = delete;
  PoseErrorModel& operator=(const PoseErrorModel&) = delete;
  virtual ~PoseErrorModel() = default;

  /// Of a move from `from` to `to`; valid in the sense of PoseError::validate.
  [[nodiscard]] virtual PoseError of_move(const View& from, const View& to) const = 0;
  /// True where every move errs alike.
  [[nodiscard]] virtual bool is_constant() const { return false; }
};

/// The same for every move: a free flyer that is held by what it sees around it.
class ConstantError : public PoseErrorModel {
 public:
  explicit ConstantError(const PoseError& error) : error_(error) { error_.validate(); }
  [[nodiscard]] PoseError of_move(const View& /*from*/, const View& /*to*/) const override { return error_; }
  [[nodiscard]] bool is_constant() const override { return true; }

 private:
  PoseError error_;
};

/// Grows with the length d of the move: the deviation along each entry is a + b d, as for a gantry that slips or a
/// robot that adds up its steps. After the scan the pose is known again by registration, so that d is counted from
/// there.
class GrowingError : public PoseErrorModel {
 public:
  /// `base`: mean and covariance of a move of length 0; its covariance must be diagonal. `deviation_per_metre`: b, in
  /// m/m and rad/m. Throws InputError otherwise.
  GrowingError(const PoseError& base, const PoseError::Vector& deviation_per_metre);
  [[nodiscard]] PoseError of_move(const View& from, const View& to) const override;

 private:
  PoseError base_;
  PoseError::Vector per_metre_;
};

/// An arm that carries the sensor on a sphere around a turntable: independent errors of the table's angle, the arm's
/// elevation and its reach. What this does to position and orientation depends on the candidate.
class TurntableArmError : public PoseErrorModel {
 public:
  struct Deviations {
    double azimuth = 0;    // of the table, radians
    double elevation = 0;  // of the arm, radians
    double reach = 0;      // metres
  };

  /// The table turns about the vertical through `center`. Throws InputError for negative deviations.
  TurntableArmError(const Deviations& deviations, const Vec3& center);
  [[nodiscard]] PoseError of_move(const View& from, const View& to) const override;

 private:
  Deviations deviations_;
  Vec3 center_;
};

}  // namespace vantage
