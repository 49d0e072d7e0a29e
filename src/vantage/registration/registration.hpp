#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vantage/core/point_cloud.hpp"
#include "vantage/registration/fusion.hpp"

namespace vantage {

/// How scans are registered. Lengths that are not given follow from the data, so that the same options serve a bunny of
/// 0.15 m and a car.
struct RegistrationOptions {
  /// Distance between neighbouring points of a scan, metres; measured from the scan where not given.
  std::optional<double> spacing;
  /// How far points may be from where the believed pose puts them, metres; one fifth of the scan's largest extent where
  /// not given.
  std::optional<double> search_radius;
  /// The finest model surface has one surfel per this many spacings.
  double finest_cell_in_spacings = 2;
  /// Iterations per level of resolution before a scan counts as not converged.
  int max_iterations = 60;
  /// Least share of the scan that must lie on the model.
  double least_overlap = 0.25;
  /// Largest RMS distance of the overlap to the model, in spacings.
  double largest_residual_in_spacings = 1;
  /// A direction is undetermined where the mean squared cosine with which the surface resists a motion is below this.
  double least_eigenvalue = 2e-3;
  /// A different pose that explains this share of what the best pose explains makes the result ambiguous.
  double ambiguity = 0.9;

  /// Throws InputError naming the field and its value.
  void validate() const;
};

enum class Verdict { registered, insufficient_overlap, not_converged, large_residual, degenerate, ambiguous };

[[nodiscard]] std::string_view name(Verdict verdict);

/// What registration found. Only a scan with the verdict `registered` may be merged.
struct Registration {
  Pose world_from_sensor = Pose::Identity();
  double overlap = 0;   // share of the scan's surface that lies on the model, 0..1
  double residual = 0;  // RMS distance of the overlap to the model's planes, metres
  Verdict verdict = Verdict::not_converged;
  int undetermined_directions = 0;  // motions that the geometry leaves open; they stay at the believed pose
  std::string explanation;          // one sentence for people

  [[nodiscard]] bool succeeded() const { return verdict == Verdict::registered; }
};

/// The model so far as registration sees it: the fused cloud of all merged scans.
class ModelSurface {
 public:
  /// `spacing`: distance between the kept points, metres.
  explicit ModelSurface(double spacing) : fused_(spacing) {}

  /// Adds a scan whose pose is known: the first one, then each one that has been registered.
  void merge(const PointCloud& scan_in_sensor, const Pose& world_from_sensor) {
    fused_.merge(scan_in_sensor, world_from_sensor);
  }
  [[nodiscard]] const PointCloud& cloud() const { return fused_.cloud(); }
  [[nodiscard]] const FusedCloud& fused() const { return fused_; }

 private:
  FusedCloud fused_;
};

/// Registers a scan (points and normals in the sensor frame) against the model so far: point-to-plane ICP from the
/// believed pose and from poses around it, coarse to fine, with a robust kernel. The result has the same bits for any
/// number of threads. Throws InputError for options out of range; everything about the data is told by the verdict.
[[nodiscard]] Registration register_scan(const ModelSurface& model, const PointCloud& scan_in_sensor,
                                         const Pose& believed_world_from_sensor,
                                         const RegistrationOptions& options = {});

}  // namespace vantage
