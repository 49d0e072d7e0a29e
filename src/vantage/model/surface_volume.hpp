#pragma once

#include <functional>
#include <optional>

#include "vantage/map/scan.hpp"
#include "vantage/model/surface_fusion.hpp"
#include "vantage/model/surface_mesh.hpp"
#include "vantage/model/surface_points.hpp"
#include "vantage/sensor/sensor_estimator.hpp"

namespace vantage {

struct SurfaceOptions {
  /// Side of the lattice cells, metres; by the sensor where not given: the distance between its pixels' points on the
  /// object, or the noise of a depth where that is larger.
  std::optional<double> cell;
  /// Where the surface would need more blocks of 8^3 cells than this, the cells become twice as long. A block takes
  /// 14 kB.
  std::size_t most_blocks = 32768;
  bool watertight = false;  // the mesh is closed where nobody saw anything
  /// Standard deviation that the surface should have, metres: the summary says how much of it has.
  std::optional<double> target_accuracy = std::nullopt;

  /// Throws InputError naming the field and its value.
  void validate() const;
};

template <class Field>
void describe(SurfaceOptions& o, Field&& field) {
  field("mesh-cell", o.cell, "m", "edge of a cell of the mesh; as fine as the sensor if not given");
  field("watertight", o.watertight, "", "close the mesh where nothing was seen");
  field("target-accuracy", o.target_accuracy, "m",
        "standard deviation that the surface should have: the summary says how much of it has");
}

/// The surface of what was scanned, as a truncated signed distance on the blocks of a lattice that it passes through
/// (Curless and Levoy 1996), built scan by scan. Samples count by 1/sigma^2 and by the cosine of the incidence. Space
/// that frames looked through becomes empty again. Both sides of a thin wall are kept apart by their normals. Same bits
/// for any number of threads.
class SurfaceVolume {
 public:
  /// Only what lies in the region (world frame) is kept.
  explicit SurfaceVolume(const Box3& region, const SurfaceOptions& options = {});

  /// Adds a scan taken from the view. Where `sensor` is not known, it is estimated from the first scans. `pose_error`:
  /// standard deviation of where the pose puts surfaces, metres.
  void fuse(const Scan& scan, const View& view, const std::optional<SensorModel>& sensor, double pose_error = 0);

  /// Metres; 0 before the first scan that has a point in the region.
  [[nodiscard]] double cell() const { return blocks_ ? blocks_->cell() : 0; }
  /// Scans added so far.
  [[nodiscard]] int frames() const { return frames_; }
  [[nodiscard]] std::size_t blocks() const { return blocks_ ? blocks_->size() : 0; }
  /// The surface that was seen, open where nothing was. Without parts that fewer than three frames saw, once there are
  /// three.
  [[nodiscard]] MeasuredMesh mesh() const;
  /// The same closed where nobody saw anything, by smooth caps in what the map does not know to be empty; a manifold.
  /// Throws InputError where the map's enclosure has too many cells.
  [[nodiscard]] MeasuredMesh closed_mesh(const VoxelMap& map) const;
  /// The one of both that the options ask for.
  [[nodiscard]] MeasuredMesh mesh(const VoxelMap& map) const { return options_.watertight ? closed_mesh(map) : mesh(); }
  [[nodiscard]] const SurfaceOptions& options() const { return options_; }

 private:
  void fuse_image(const RangeImage& image, const View& view, const SurfaceNoise& noise, std::uint16_t number);
  void fuse_points(const PointScan& scan, const View& view, const SurfaceNoise& noise, std::uint16_t number);
  [[nodiscard]] SensorModel estimate_sensor(const RangeImage& image);
  /// Makes the blocks whose keys `keys_at` gives for a cell; the cell grows until they are few enough. Returns how many
  /// there were before.
  std::size_t make_blocks(SurfaceBlocks& blocks, const std::function<std::vector<Index3>(double)>& keys_at) const;

  Box3 region_;
  SurfaceOptions options_;
  std::optional<SurfaceBlocks> blocks_;
  int frames_ = 0;
  SensorEstimator estimator_;
  double least_sigma_ = 0;  // of a depth, metres: what pixels cannot tell apart
};

}  // namespace vantage
