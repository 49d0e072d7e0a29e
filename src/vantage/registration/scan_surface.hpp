#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vantage/core/point_cloud.hpp"
#include "vantage/registration/free_space.hpp"
#include "vantage/sensor/sensor_model.hpp"

namespace vantage {

/// A small piece of a measured surface.
struct SurfaceSample {
  Vec3 point;
  Vec3 normal;       // unit, towards the sensor
  double sigma = 0;  // standard deviation of the point along the normal, metres
};

/// A scan as registration sees it, sensor frame: some thousands of samples, each the plane through a neighbourhood that
/// is large enough for its normal to stand out of the noise, and the space that the scan shows to be empty. It follows
/// from the measurements alone (not from any voxels), and its size is bounded.
struct ScanSurface {
  std::vector<SurfaceSample> samples;
  double spacing = 0;  // typical distance between neighbouring samples, metres
  double sigma = 0;    // typical standard deviation of a measured depth, metres
  std::optional<FreeSpace> free_space;
};

/// RMS distance of samples between two poses, metres. Of many samples every n-th counts, so that at most `most` do.
[[nodiscard]] double distance_between(std::span<const SurfaceSample> samples, const Pose& a, const Pose& b,
                                      std::size_t most);

struct ScanSurfaceOptions {
  int max_samples = 32000;
  /// Standard deviation that a sample's normal should have, radians: decides how large a neighbourhood is averaged.
  double normal_sigma = 0.1;
  /// Part of the depths' standard deviation that neighbouring pixels have in common, so that averaging does not
  /// remove it.
  double shared_error = 0.3;

  void validate() const;
};

/// The deviation of the depths of a sensor that is not known: that of common stereo and structured-light
/// cameras.
constexpr SensorModel usual_sensor{.constant = 0.001, .quadratic = 0.002};

/// Of a range image. Its depths err as is usual where the sensor is not given.
[[nodiscard]] ScanSurface scan_surface(const RangeImage& image, const std::optional<SensorModel>& sensor,
                                       const ScanSurfaceOptions& options = {});

/// Of points in the sensor frame whose sight lines start at `origins` (one for all, or one each). Normals come from the
/// neighbours; a normal that is given (not zero) says on which side of its surface a point was seen, elsewhere the
/// origin does. Where the sensor is not given the cloud itself shows how thick its surfaces are.
[[nodiscard]] ScanSurface scan_surface(const PointCloud& cloud, std::span<const Vec3> origins,
                                       const std::optional<SensorModel>& sensor,
                                       const ScanSurfaceOptions& options = {});

/// Side of a square of points `spacing` apart and off by `sigma` whose plane is tilted by `normal_sigma` (radians,
/// standard deviation), metres: of (side / spacing)^2 = n points it is sigma sqrt(12 / n) / side.
[[nodiscard]] double neighborhood_side(double sigma, double spacing, double normal_sigma);

}  // namespace vantage
