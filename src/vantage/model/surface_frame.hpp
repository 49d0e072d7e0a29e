#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/sensor_model.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// How far off the surface a scan may put a point: by the sensor, and by the pose that the scan was given.
struct SurfaceNoise {
  SensorModel sensor;
  double pose = 0;  // standard deviation, metres

  [[nodiscard]] double sigma(double depth, double cosine = 1) const {
    return std::hypot(sensor.sigma(depth, cosine), pose);
  }
};

/// A pixel as fusion wants it: the plane of the surface around it and how much to trust it.
struct SurfacePixel {
  float depth = 0;               // as in a RangeImage
  Vec3f normal = Vec3f::Zero();  // sensor frame, facing the sensor
  float sigma = 0;               // of the depth, metres
  float weight = 0;              // cosine of the incidence over the variance of the depth, 1/m^2
  float nearest = 0;             // depth of the nearest surface in this pixel and the eight around it; infinity: none
};

/// A range image with the planes around its pixels: each is fitted to a window of pixels in which the surface does not
/// jump, as wide as the noise asks for so that the normal is good to about 0.1 rad.
class SurfaceFrame {
 public:
  SurfaceFrame(const RangeImage& image, const SurfaceNoise& noise);

  [[nodiscard]] const RayGrid& rays() const { return rays_; }
  [[nodiscard]] double min_depth() const { return min_depth_; }
  [[nodiscard]] double max_depth() const { return max_depth_; }
  [[nodiscard]] const SurfacePixel& pixel(int column, int row) const {
    return pixels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(rays_.resolution.columns) +
                   static_cast<std::size_t>(column)];
  }

 private:
  void find_planes(const RangeImage& image, const SurfaceNoise& noise);
  void find_nearest();

  RayGrid rays_;
  double min_depth_ = 0, max_depth_ = 0;
  std::vector<SurfacePixel> pixels_;
};

/// Median distance between neighbouring pixels' points across the line of sight among those in a box (world frame),
/// metres; nothing where no pixel is in it.
[[nodiscard]] std::optional<double> pixel_spacing(const RangeImage& image, const View& view, const Box3& box);

}  // namespace vantage
