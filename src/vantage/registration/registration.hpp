#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vantage/core/point_cloud.hpp"
#include "vantage/registration/free_space.hpp"
#include "vantage/registration/fusion.hpp"

namespace vantage {

/// How scans are registered. Lengths that are not given follow from the data, so that the same options serve a bunny of
/// 0.15 m and a car.
struct RegistrationOptions {
  /// Distance between neighbouring points of a scan, metres; measured from the scan where not given.
  std::optional<double> spacing;
  /// How far points may be from where the believed pose puts them (three standard deviations), metres; one fifth of the
  /// scan's largest extent where not given.
  std::optional<double> search_radius;
  /// The finest resolution has one surfel per this many spacings, or coarser where the scan's noise hides the surface.
  double finest_cell_in_spacings = 1;
  /// Iterations per level of resolution before a scan counts as not converged.
  int max_iterations = 60;
  /// Least share of the scan that must lie on the model.
  double least_overlap = 0.1;
  /// Largest RMS distance of the overlap to the model, in sides of the finest surfels.
  double largest_residual_in_cells = 0.5;
  /// A direction is undetermined where the mean squared cosine with which the surface resists a motion is below this.
  double least_resistance = 1e-3;
  /// Standard deviation of the believed orientation about each axis, radians. Undetermined directions keep what is
  /// believed; where that may put surfaces visibly off each other, the scan is refused as degenerate.
  double orientation_error = radians(1);
  /// Directions that the surface leaves open keep what is believed of them; where that may put surfaces farther off
  /// each other than this, metres, the scan is refused as degenerate. A side of the finest surfels where not given.
  std::optional<double> largest_open_misfit;
  /// Resistance to moving away from the believed pose, in the unit of least_resistance. 0: the surfaces alone decide,
  /// which suits clean scans; with noise and outliers a little trust keeps weakly held directions from following them.
  double trust = 0;
  /// The same on the finest level, where the pose is already near: `trust` where not given. Trust pulls what the
  /// surface holds weakly towards the believed pose by a part of its error.
  std::optional<double> trust_at_last;
  /// Largest share of the scan's points that may lie in space which earlier range images show to be empty, or of the
  /// model's points in space which this scan's range image shows to be empty.
  double largest_share_in_free_space = 0.01;
  /// A different pose that explains this share of what the best pose explains makes the result ambiguous.
  double ambiguity = 0.9;

  /// Throws InputError naming the field and its value.
  void validate() const;
};

enum class Verdict {
  registered,
  insufficient_overlap,  // too little of the scan lies on the model
  not_converged,         // the pose still moved after the last iteration, or ended farther off than the search reaches
  large_residual,        // the overlap does not fit
  degenerate,            // the overlap leaves motions open in which the believed pose is not good enough
  in_free_space,         // surfaces would stand where a sensor has looked through
  ambiguous,             // a different pose fits about as well
};

[[nodiscard]] std::string_view name(Verdict verdict);

/// What registration found. Only a scan with the verdict `registered` may be merged.
struct Registration {
  Pose world_from_sensor = Pose::Identity();
  double overlap = 0;   // share of the scan's flat surfels that lie on the model, 0..1
  double residual = 0;  // RMS distance of the overlap to the model's planes, metres
  Verdict verdict = Verdict::not_converged;
  int undetermined_directions = 0;  // motions that the geometry leaves open; they stay at the believed pose
  std::string explanation;          // one sentence for people

  [[nodiscard]] bool succeeded() const { return verdict == Verdict::registered; }
};

/// The model so far as registration sees it: the fused cloud of all merged scans, and what their range images say about
/// empty space.
class ModelSurface {
 public:
  /// `spacing`: distance between the kept points, metres.
  explicit ModelSurface(double spacing) : fused_(spacing) {}

  /// Adds a scan whose pose is known: the first one, then each one that has been registered.
  void merge(const PointCloud& scan_in_sensor, const Pose& world_from_sensor) {
    fused_.merge(scan_in_sensor, world_from_sensor);
  }
  /// The same with the range image of which `scan_in_sensor` are the points: it also tells where nothing is.
  void merge(const PointCloud& scan_in_sensor, RangeImage image, const Pose& world_from_sensor) {
    fused_.merge(scan_in_sensor, world_from_sensor);
    if (merged_images_++ % every_ != 0) return;
    images_.push_back({std::move(image), world_from_sensor});
    if (images_.size() <= most_images) return;
    every_ *= 2;
    for (std::size_t i = 1; 2 * i < images_.size(); ++i) images_[i] = std::move(images_[2 * i]);
    images_.resize((images_.size() + 1) / 2);
  }
  [[nodiscard]] const PointCloud& cloud() const { return fused_.cloud(); }
  [[nodiscard]] const FusedCloud& fused() const { return fused_; }
  /// All range images; of more than `most_images` every second, fourth ... one, so that memory does not grow for ever.
  [[nodiscard]] std::span<const PosedImage> images() const { return images_; }
  static constexpr std::size_t most_images = 64;

 private:
  FusedCloud fused_;
  std::vector<PosedImage> images_;
  std::size_t merged_images_ = 0, every_ = 1;
};

/// Registers a scan (points and normals in the sensor frame) against the model so far: point-to-plane ICP from the
/// believed pose and from poses around it, coarse to fine, with a robust kernel. The result has the same bits for any
/// number of threads. Throws InputError for options out of range; everything about the data is reported by the verdict.
[[nodiscard]] Registration register_scan(const ModelSurface& model, const PointCloud& scan_in_sensor,
                                         const Pose& believed_world_from_sensor,
                                         const RegistrationOptions& options = {});
/// The same with the range image of which `scan_in_sensor` are the points: the verdict then also rests on free space.
[[nodiscard]] Registration register_scan(const ModelSurface& model, const PointCloud& scan_in_sensor,
                                         const RangeImage& image, const Pose& believed_world_from_sensor,
                                         const RegistrationOptions& options = {});

}  // namespace vantage
