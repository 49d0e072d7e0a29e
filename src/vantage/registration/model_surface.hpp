#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vantage/core/error.hpp"
#include "vantage/registration/fusion.hpp"
#include "vantage/registration/scan_surface.hpp"
#include "vantage/registration/surfel_map.hpp"

namespace vantage {

/// What a scan shows to be empty, and where it was taken.
struct PosedFreeSpace {
  FreeSpace space;
  Pose world_from_sensor = Pose::Identity(), sensor_from_world = Pose::Identity();
};

/// The surface so far that scans are registered against. Its size, and the time that registering takes, depend on the
/// surface that has been seen and not on the number of scans; nor on any voxel.
class RegisteredSurface {
 public:
  /// Adds a scan whose pose is known: the first one, then each one that has been registered.
  void merge(const ScanSurface& scan, const Pose& world_from_sensor);

  [[nodiscard]] bool empty() const { return !surfels_; }
  /// Only where it is not empty.
  [[nodiscard]] const SurfelMap& surfels() const {
    if (!surfels_) throw Error("registered surface: has no scan");
    return *surfels_;
  }
  /// Of at most 32 scans, those that see the most different things.
  [[nodiscard]] std::span<const PosedFreeSpace> free_spaces() const { return free_spaces_; }
  /// Largest typical standard deviation of a scan's depths, metres.
  [[nodiscard]] double sigma() const { return sigma_; }

 private:
  static constexpr std::size_t most_free_spaces = 32;

  void keep(const FreeSpace& space, const Pose& world_from_sensor);

  std::optional<SurfelMap> surfels_;
  std::vector<PosedFreeSpace> free_spaces_;
  double sigma_ = 0;
};

/// The model so far: what scans are registered against, and the fused cloud of all of them.
class ModelSurface {
 public:
  /// `spacing`: distance between the points that the fused cloud keeps, metres. Registration does not depend on it.
  explicit ModelSurface(double spacing) : fused_(spacing) {}

  /// Adds points (sensor frame) to the fused cloud.
  void merge(const PointCloud& scan_in_sensor, const Pose& world_from_sensor) {
    fused_.merge(scan_in_sensor, world_from_sensor);
  }
  /// Adds a scan to what others are registered against.
  void merge(const ScanSurface& scan, const Pose& world_from_sensor) { registered_.merge(scan, world_from_sensor); }

  [[nodiscard]] const PointCloud& cloud() const { return fused_.cloud(); }
  [[nodiscard]] const FusedCloud& fused() const { return fused_; }
  [[nodiscard]] const RegisteredSurface& registered() const { return registered_; }

 private:
  FusedCloud fused_;
  RegisteredSurface registered_;
};

}  // namespace vantage
