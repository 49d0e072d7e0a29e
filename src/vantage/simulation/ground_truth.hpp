#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/candidates/candidates.hpp"
#include "vantage/core/point_cloud.hpp"
#include "vantage/map/voxel_map.hpp"
#include "vantage/simulation/mesh_tools.hpp"
#include "vantage/simulation/range_scanner.hpp"

namespace vantage {

struct GroundTruthOptions {
  int samples = 400'000;   // points on the true surface; at least 1
  std::uint64_t seed = 1;  // of the samples

  void validate() const;
};

/// How far the points of a model lie from the true surface, in metres; all 0 for an empty model.
struct Accuracy {
  double root_mean_square = 0;
  double percentile_95 = 0;
  double maximum = 0;
};

/// Shares of the true surface that have a model point nearby.
struct Completeness {
  double visible = 0;  // of the surface in visible voxels
  double all = 0;      // of the whole surface
};

/// What there is to see of an object, and how much of it a model holds (spec, section 8). Areas are counted by samples
/// that stand for equal areas. A voxel is visible if a noise-free scan from one of the given views puts a point into
/// it.
class GroundTruth {
 public:
  /// The scanner must outlive the ground truth. Scans from all `views`, in parallel. Throws InputError where the grid
  /// or the camera is invalid.
  GroundTruth(const RangeScanner& scanner, const Grid& grid, const IndexBox& enclosure, const RangeCamera& camera,
              std::span<const View> views, const GroundTruthOptions& options = {});

  /// Surface area in visible voxels that are occupied in the map, as a share of the area in visible voxels; 0 where
  /// nothing is visible. The map must have the grid and enclosure of the ground truth (InputError).
  [[nodiscard]] double coverage(const VoxelMap& map) const;
  /// The same area as a share of the whole surface, seen or not.
  [[nodiscard]] double coverage_all(const VoxelMap& map) const;

  [[nodiscard]] bool is_visible(const Index3& voxel) const;
  [[nodiscard]] std::int64_t visible_voxels() const;

  /// Distances from the points of a model to the true surface.
  [[nodiscard]] Accuracy accuracy(const PointCloud& cloud) const;
  /// Shares of the surface within `tolerance` metres of a point of the model.
  [[nodiscard]] Completeness completeness(const PointCloud& cloud, double tolerance = 0.005) const;

 private:
  /// A visible voxel as a bit of the plane, and how many samples lie in it.
  struct VoxelSamples {
    std::size_t word;
    std::uint64_t bit;
    std::int64_t samples;
  };

  void mark_visible(const RangeImage& image, const View& view);
  void count_samples();
  /// Samples in visible voxels that are occupied in the map.
  [[nodiscard]] std::int64_t covered_samples(const VoxelMap& map) const;

  const RangeScanner* scanner_;
  Grid grid_;
  IndexBox enclosure_;
  BitLayout layout_;
  BitPlane visible_;
  std::vector<MeshSample> samples_;
  std::vector<VoxelSamples> visible_surface_;
  std::int64_t visible_samples_ = 0;
};

/// The views that decide what is visible: all of a view sphere or of a list, every 16th of a view cube (spec, section
/// 8).
[[nodiscard]] std::vector<View> visibility_views(const Candidates& candidates);

}  // namespace vantage
