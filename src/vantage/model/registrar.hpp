#pragma once

#include <functional>
#include <optional>
#include <string>

#include "vantage/core/point_cloud.hpp"
#include "vantage/map/scan.hpp"
#include "vantage/registration/registration.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// Where a scan was taken from, as far as could be found out.
struct Located {
  View view;
  bool accepted = true;
  double overlap = 1;   // share of the scan's points that lie on the model
  double residual = 0;  // metres
  std::string verdict;  // one word
  std::string detail;   // a sentence for people
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
};

/// Takes the robot's word for its pose.
class TrustingRegistrar : public Registrar {
 public:
  [[nodiscard]] Located locate(const ModelSurface&, const Scan&, const PointCloud&, const View& believed) override {
    return {believed, true, 1, 0, "believed", "the robot's own pose"};
  }
};

/// Knows the true pose (simulation; the paper's experiments).
class TruthRegistrar : public Registrar {
 public:
  explicit TruthRegistrar(std::function<View()> true_view) : true_view_(std::move(true_view)) {}
  [[nodiscard]] Located locate(const ModelSurface&, const Scan&, const PointCloud&, const View&) override {
    return {true_view_(), true, 1, 0, "truth", "the simulation's true pose"};
  }

 private:
  std::function<View()> true_view_;
};

/// Moves the believed pose to where the scan fits the model best; the first scan stays where it is believed to be.
class IcpRegistrar : public Registrar {
 public:
  /// Only points in `region` (world frame, by the believed pose) take part where it is given: what is known to stand
  /// still.
  explicit IcpRegistrar(const RegistrationOptions& options = {}, const std::optional<Box3>& region = {})
      : options_(options), region_(region) {
    options_.validate();
  }
  [[nodiscard]] Located locate(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                               const View& believed) override;

 private:
  RegistrationOptions options_;
  std::optional<Box3> region_;
};

}  // namespace vantage
