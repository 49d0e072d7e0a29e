#include "vantage/formats/lens.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vantage {
namespace {

using Point2 = Eigen::Vector2d;

/// A lens as a map of the image plane (coordinates over depth).
class Lens {
 public:
  /// `farthest`: radius of the image plane up to which it is asked.
  Lens(const Intrinsics& intrinsics, double farthest) : model_(intrinsics.lens) {
    std::copy(intrinsics.distortion.begin(), intrinsics.distortion.end(), c_.begin());
    const Mat3 tilt =
        (Eigen::AngleAxisd(-c_[13], Vec3::UnitY()) * Eigen::AngleAxisd(-c_[12], Vec3::UnitX())).toRotationMatrix();
    tilt_ << tilt(2, 2), 0, -tilt(0, 2), 0, tilt(2, 2), -tilt(1, 2), 0, 0, 1;
    tilt_ = (tilt_ * tilt).eval();
    turn_ = turning_point(farthest);
  }

  /// Whether the model says anything at this point.
  [[nodiscard]] bool covers(const Point2& point) const { return point.norm() < turn_; }

  /// Where the lens puts a point.
  [[nodiscard]] Point2 distorted(const Point2& p) const {
    const double r2 = p.squaredNorm();
    const double radius = std::sqrt(r2);
    if (model_ == LensModel::equidistant) return radius > 0 ? Point2(p * (bent(radius) / radius)) : p;
    const double radial = radius > 0 ? bent(radius) / radius : 1;
    const double xy = p.x() * p.y(), r4 = r2 * r2;
    const Vec3 bent_point(
        p.x() * radial + 2 * c_[2] * xy + c_[3] * (r2 + 2 * p.x() * p.x()) + c_[8] * r2 + c_[9] * r4,
        p.y() * radial + c_[2] * (r2 + 2 * p.y() * p.y()) + 2 * c_[3] * xy + c_[10] * r2 + c_[11] * r4, 1);
    const Vec3 tilted = tilt_ * bent_point;
    return tilted.head<2>() / tilted.z();
  }

 private:
  /// The radius that a point at this radius is moved to.
  [[nodiscard]] double bent(double radius) const {
    if (model_ == LensModel::equidistant) {
      const double angle = std::atan(radius), a2 = angle * angle;
      return angle * (1 + a2 * (c_[0] + a2 * (c_[1] + a2 * (c_[2] + a2 * c_[3]))));
    }
    const double r2 = radius * radius;
    const double below = 1 + r2 * (c_[5] + r2 * (c_[6] + r2 * c_[7]));
    if (!(below > 0)) return -std::numeric_limits<double>::infinity();  // beyond a pole
    return radius * (1 + r2 * (c_[0] + r2 * (c_[1] + r2 * c_[4]))) / below;
  }

  /// The radius from which on points no longer move outwards.
  [[nodiscard]] double turning_point(double farthest) const {
    constexpr int steps = 4096;  // a quarter of a pixel in the widest images
    double before = 0;
    for (int i = 1; i <= steps; ++i) {
      const double radius = farthest * i / steps;
      const double moved = bent(radius);
      if (!(moved > before)) return farthest * (i - 1) / steps;
      before = moved;
    }
    return std::numeric_limits<double>::infinity();
  }

  LensModel model_;
  std::array<double, 14> c_{};
  Mat3 tilt_;
  double turn_ = 0;
};

template <class Values>
Values moved(const Values& values, const Intrinsics& intrinsics, Resolution resolution) {
  const std::vector<std::int32_t> sources = distorted_pixels(intrinsics, resolution);
  Values result(values.size(), 0);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (sources[i] >= 0) result[i] = values[static_cast<std::size_t>(sources[i])];
  }
  return result;
}

}  // namespace

std::vector<std::int32_t> distorted_pixels(const Intrinsics& intrinsics, Resolution resolution) {
  intrinsics.validate();
  const auto [columns, rows] = resolution;
  const auto in_plane = [&](int column, int row) {
    return Point2((column - intrinsics.cx) / intrinsics.fx, (row - intrinsics.cy) / intrinsics.fy);
  };
  double farthest = 0;
  for (const int column : {0, columns - 1}) {
    for (const int row : {0, rows - 1}) farthest = std::max(farthest, in_plane(column, row).norm());
  }
  const Lens lens(intrinsics, farthest);
  std::vector<std::int32_t> sources(static_cast<std::size_t>(resolution.rays()), -1);
  std::size_t pixel = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column, ++pixel) {
      const Point2 ideal = in_plane(column, row);
      if (!lens.covers(ideal)) continue;
      const Point2 there = lens.distorted(ideal);
      const double u = std::round(intrinsics.fx * there.x() + intrinsics.cx);
      const double v = std::round(intrinsics.fy * there.y() + intrinsics.cy);
      if (u >= 0 && u < columns && v >= 0 && v < rows)
        sources[pixel] = static_cast<std::int32_t>(v) * columns + static_cast<std::int32_t>(u);
    }
  }
  return sources;
}

Gray16 undistorted(Gray16 image, const Intrinsics& intrinsics) {
  if (intrinsics.is_distorted()) image.values = moved(image.values, intrinsics, image.resolution);
  return image;
}

FloatImage undistorted(FloatImage image, const Intrinsics& intrinsics) {
  if (intrinsics.is_distorted()) image.values = moved(image.values, intrinsics, image.resolution);
  return image;
}

RangeImage undistorted(RangeImage image, const Intrinsics& intrinsics) {
  if (intrinsics.is_distorted()) image.depth = moved(image.depth, intrinsics, image.camera.resolution);
  return image;
}

}  // namespace vantage
