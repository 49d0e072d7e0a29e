#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "vantage/registration/pose_graph.hpp"
#include "vantage/registration/scan_pairs.hpp"

namespace vantage {

/// All merged scans with how they lie to each other: a pose graph that grows scan by scan. Adding one takes the same
/// time however many there are.
class ScanGraph {
 public:
  /// A scan that was merged at `world_from_sensor`. `prior`: what was believed of its pose before it was registered.
  /// Pairs it with the scans that overlap most with it.
  void add(int number, const ScanSurface& surface, const PoseEstimate& prior, const Pose& world_from_sensor);

  /// It turned out to be in a wrong place.
  void remove(int number);

  [[nodiscard]] std::size_t size() const { return scans_.size(); }
  [[nodiscard]] std::size_t pairs() const { return constraints_.size(); }
  /// True where so many scans have come since the last improve() that it is worth another: four, and a quarter of all,
  /// so that its cost per scan does not grow.
  [[nodiscard]] bool is_due() const;

  /// Poses that agree best with all pairs and priors, and how far the surfaces move to them at most (mean over the
  /// samples of a scan), metres.
  struct Improved {
    std::map<int, Pose> world_from_sensor;  // by number
    double largest_move = 0;
  };
  [[nodiscard]] Improved improve();
  /// The scans are where they were improved to from now on.
  void accept(const Improved& improved);

 private:
  struct Scan {
    int number = 0;
    std::shared_ptr<const PairedSurface> surface;  // nothing where later scans are not laid on it any more
    Pose world_from_sensor;
  };
  [[nodiscard]] std::vector<std::size_t> neighbours(const PairedSurface& surface, const Pose& world_from_sensor) const;

  void forget_a_surface();

  std::vector<Scan> scans_;
  std::vector<PosePrior> priors_;
  std::vector<PoseConstraint> constraints_;
  std::size_t size_at_last_ = 0;
};

}  // namespace vantage
