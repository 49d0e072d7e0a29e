#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "vantage/core/point_cloud.hpp"
#include "vantage/map/scan.hpp"
#include "vantage/registration/registration.hpp"
#include "vantage/robot/error_model.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// Where a scan was taken from, as far as could be found out.
struct Located {
  View view;
  bool accepted = true;
  double overlap = 1;        // share of the scan's surface that lies on the model
  double residual = 0;       // metres
  std::string verdict = {};  // one word
  std::string detail = {};   // a sentence for people
  /// Of pose_step(view, the true one); 0 where the pose is taken as it is.
  Mat6 covariance = Mat6::Zero();
  int undetermined_directions = 0;  // in which the pose stays as believed, mean and covariance
  double value = 0, limit = 0;      // what the verdict rests on
  /// What later scans are registered against; nothing where nobody registers.
  std::shared_ptr<const ScanSurface> surface = {};
};

/// Finds the pose of each scan against the model so far.
class Registrar {
 public:
  Registrar() = default;
  Registrar(const Registrar&) = delete;
  Registrar& operator=(const Registrar&) = delete;
  virtual ~Registrar() = default;

  /// `model` holds all scans merged so far; the first scan meets an empty one. `points` are those of the scan.
  [[nodiscard]] virtual Located locate(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                                       const View& believed) = 0;
  /// What the robot alone says of the pose of the next scan, in its own frame. Asked once for every scan, in their
  /// order.
  [[nodiscard]] virtual PoseEstimate prior(const ModelSurface& /*model*/, const View& believed) {
    return {believed.world_from_sensor, Mat6::Zero()};
  }
  /// The same as locate() where more is known of the pose, in the frame of the model.
  [[nodiscard]] virtual Located locate_from(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                                            const PoseEstimate& known) {
    return locate(model, scan, points, View{known.mean});
  }
  /// The scan as registration sees it, for one whose pose has been found before; nothing where it does not look.
  [[nodiscard]] virtual std::shared_ptr<const ScanSurface> surface_of(const Scan& /*scan*/,
                                                                      const PointCloud& /*points*/,
                                                                      const View& /*believed*/) const {
    return nullptr;
  }
  /// From now on the robot is believed to err like this.
  virtual void believe(const PoseError& /*error*/) {}
  /// True where the pose is found out from the model, so that it may be found later where it is not found now.
  [[nodiscard]] virtual bool estimates() const { return true; }
};

/// Takes the robot's word for its pose.
class TrustingRegistrar : public Registrar {
 public:
  [[nodiscard]] Located locate(const ModelSurface&, const Scan&, const PointCloud&, const View& believed) override {
    return {believed, true, 1, 0, "believed", "the robot's own pose"};
  }
  [[nodiscard]] bool estimates() const override { return false; }
};

/// Knows the true pose (simulation; the paper's experiments).
class TruthRegistrar : public Registrar {
 public:
  explicit TruthRegistrar(std::function<View()> true_view) : true_view_(std::move(true_view)) {}
  [[nodiscard]] Located locate(const ModelSurface&, const Scan&, const PointCloud&, const View&) override {
    return {true_view_(), true, 1, 0, "truth", "the simulation's true pose"};
  }
  [[nodiscard]] bool estimates() const override { return false; }

 private:
  std::function<View()> true_view_;
};

/// Errors of which a robot of unknown kind stays within 5 cm and 5 degrees (three standard deviations).
[[nodiscard]] PoseError usual_pose_error();

/// What is known about scans before they are registered.
struct RegistrarOptions {
  /// How the robot errs from move to move.
  std::shared_ptr<const PoseErrorModel> error = std::make_shared<ConstantError>(usual_pose_error());
  std::optional<SensorModel> sensor;  // as is usual, or as the scan shows, where it is not told
  /// Only points in this box (world frame, by the believed pose) take part where it is given: what is known to stand
  /// still.
  std::optional<Box3> region;
  bool first_is_exact = false;  // the first scan is where it is believed to be
  RegistrationOptions registration;
};

/// Moves the believed pose to where it is most probable, by how the robot errs and how the scan fits the model; the
/// first scan stays where it is believed to be.
class IcpRegistrar : public Registrar {
 public:
  explicit IcpRegistrar(RegistrarOptions options = {});
  [[nodiscard]] Located locate(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                               const View& believed) override;
  [[nodiscard]] PoseEstimate prior(const ModelSurface& model, const View& believed) override;
  [[nodiscard]] Located locate_from(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                                    const PoseEstimate& known) override;
  [[nodiscard]] std::shared_ptr<const ScanSurface> surface_of(const Scan& scan, const PointCloud& points,
                                                              const View& believed) const override;
  void believe(const PoseError& error) override;

 private:
  RegistrarOptions options_;
  std::optional<View> last_;  // where the sensor was before
};

/// Where the sensor is after a move to `commanded` that errs like this.
[[nodiscard]] PoseEstimate pose_estimate(const View& commanded, const PoseError& error);

}  // namespace vantage
