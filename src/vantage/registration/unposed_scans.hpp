#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "vantage/registration/feature_matches.hpp"
#include "vantage/registration/register_anywhere.hpp"

namespace vantage {

/// A scan by its features, and where it was taken from.
struct PosedFeatures {
  std::shared_ptr<const SurfaceFeatures> features;
  Pose world_from_sensor = Pose::Identity();
};

/// Poses of a scan that scans of known pose suggest, those that most places speak for first; at most `most`.
[[nodiscard]] std::vector<Pose> suggested_poses(const std::vector<PosedFeatures>& known, const SurfaceFeatures& scan,
                                                std::size_t most);

/// A scan of a set without poses.
struct UnposedScan {
  std::optional<Pose> world_from_sensor;  // nothing where it was not found
  Registration found;                     // of the last attempt; of the scan that defines the frame nothing
  std::vector<Pose> alternatives;         // of an ambiguous one
  std::optional<std::size_t> rank;        // in the order in which scans were found, from 0
};

/// Where the scans of a set were taken from, found from the scans alone. The scan that most others resemble begins;
/// then always that one follows which most places of those found so far speak for. What does not fit yet is tried again
/// as the model grows. The world is the frame of the first scan where that was found, else of the one that began. The
/// same bits for any number of threads.
[[nodiscard]] std::vector<UnposedScan> find_poses(const std::vector<ScanSurface>& scans,
                                                  const AnywhereOptions& options = {});

}  // namespace vantage
