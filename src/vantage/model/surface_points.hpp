#pragma once

#include "vantage/model/surface_blocks.hpp"
#include "vantage/model/surface_frame.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage {

/// A scan of points with sight lines as fusion wants it: what a SurfaceFrame is to a range image. World frame.
class SurfacePoints {
 public:
  struct Point {
    Vec3f place;
    Vec3f direction;  // from the sensor, unit
    Vec3f normal;     // facing the sensor
    float weight;     // cosine of the incidence over the variance of the depth, 1/m^2
  };
  /// Of the points, those in the region, and all sight lines that may pass it.
  SurfacePoints(const PointScan& scan, const View& view, const SurfaceNoise& noise, const Box3& region);

  [[nodiscard]] bool empty() const { return points_.empty(); }
  [[nodiscard]] std::span<const Point> points() const { return points_; }
  struct Line {
    Vec3 from, to;  // to the point that ends it
  };
  [[nodiscard]] std::span<const Line> lines() const { return lines_; }
  /// Median distance between neighbouring points, metres.
  [[nodiscard]] double spacing() const { return spacing_; }
  /// Standard deviation of the points, metres: the noise given, or how far neighbours lie off each other's planes where
  /// that is more.
  [[nodiscard]] double sigma() const { return sigma_; }

 private:
  void measure_spacing_and_sigma(double given_sigma);

  std::vector<Point> points_;
  std::vector<Line> lines_;
  double spacing_ = 0, sigma_ = 0;
};

/// Keys of the blocks that the points and the band around them touch, as far as they meet the region; sorted.
[[nodiscard]] std::vector<Index3> blocks_near(const SurfacePoints& points, double cell, const Box3& region);
/// Tells every node near the points how far it lies from the surface, and those that sight lines pass that they were
/// looked through.
void fuse(SurfaceBlocks& blocks, const SurfacePoints& points, const Box3& region, std::uint16_t number);

}  // namespace vantage
