#include "vantage/formats/lens.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace vantage {
namespace {

/// Distances in pixels between where an ideal pixel is seen and where `model` (tangents to tangents) puts it.
template <class Model>
double worst_error(const Intrinsics& k, Resolution size, const Model& model, int& asked) {
  const std::vector<std::int32_t> sources = distorted_pixels(k, size);
  double worst = 0;
  asked = 0;
  for (int row = 0; row < size.rows; ++row) {
    for (int column = 0; column < size.columns; ++column) {
      const std::int32_t source = sources[static_cast<std::size_t>(row * size.columns + column)];
      if (source < 0) continue;
      const Eigen::Vector2d there = model(Eigen::Vector2d((column - k.cx) / k.fx, (row - k.cy) / k.fy));
      const Eigen::Vector2d pixel(k.fx * there.x() + k.cx, k.fy * there.y() + k.cy);
      worst = std::max(worst,
                       (pixel - Eigen::Vector2d(source % size.columns, source / size.columns)).cwiseAbs().maxCoeff());
      ++asked;
    }
  }
  return worst;
}

TEST(Undistorted, APlaneSeenThroughALensIsAPlaneAgain) {
  // The depth of a tilted plane as a distorted camera measures it: pixel (u, v) looks along the ray whose distorted
  // image it is.
  Intrinsics intrinsics{.fx = 300,
                        .fy = 300,
                        .cx = 159.5,
                        .cy = 119.5,
                        .resolution = std::nullopt,
                        .distortion = {-0.25, 0.08, 0.001, -0.001, 0}};
  const RangeCamera camera = pinhole_camera(intrinsics, {320, 240});
  const auto plane_depth = [](double x, double y) { return static_cast<float>(2 / (1 + 0.3 * x + 0.2 * y)); };
  RangeImage seen{camera, std::vector<float>(320 * 240)};
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const double xd = (u - 159.5) / 300, yd = (v - 119.5) / 300;
      double x = xd, y = yd;
      for (int i = 0; i < 50; ++i) {  // invert the lens by fixed-point iteration
        const double r2 = x * x + y * y, radial = 1 - 0.25 * r2 + 0.08 * r2 * r2;
        const double dx = 2 * 0.001 * x * y - 0.001 * (r2 + 2 * x * x),
                     dy = 0.001 * (r2 + 2 * y * y) - 2 * 0.001 * x * y;
        x = (xd - dx) / radial;
        y = (yd - dy) / radial;
      }
      seen.depth[static_cast<std::size_t>(v * 320 + u)] = plane_depth(x, y);
    }
  }
  const RangeImage corrected = undistorted(seen, intrinsics);
  const RayGrid rays = camera.rays();
  int compared = 0;
  double worst_before = 0;
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      if (!RangeImage::is_hit(corrected.at(u, v))) continue;
      const double expected = static_cast<double>(plane_depth(rays.x(u), rays.y(v)));
      // The nearest pixel is at most half a pixel away on each axis, 1.35 times that without the lens (at the corners),
      // and the depth z of this plane changes by z^2/2 (0.3 dx + 0.2 dy).
      const double tolerance = 0.5 * expected * expected * (0.3 + 0.2) * 1.35 * 0.5 / 300;
      ASSERT_NEAR(static_cast<double>(corrected.at(u, v)), expected, tolerance);
      worst_before = std::max(worst_before, std::abs(static_cast<double>(seen.at(u, v)) - expected));
      ++compared;
    }
  }
  EXPECT_GT(compared, 70'000);
  EXPECT_GT(worst_before, 0.01) << "there was something to correct";
  intrinsics.distortion = {0, 0, 0};
  EXPECT_EQ(undistorted(seen, intrinsics).depth, seen.depth);
}

TEST(Undistorted, AnEquidistantLensTurnsAnglesIntoRadii) {
  // An image of a lens that puts the angle, times a polynomial, where the tangent would be; without one it is no
  // pinhole either.
  for (const std::vector<double>& k : {std::vector<double>{}, std::vector<double>{0.02, -0.01, 0.003, -0.0005}}) {
    const Intrinsics intrinsics{.fx = 100,
                                .fy = 101,
                                .cx = 159.5,
                                .cy = 119.5,
                                .resolution = std::nullopt,
                                .distortion = k,
                                .lens = LensModel::equidistant};
    EXPECT_TRUE(intrinsics.is_distorted());
    int asked = 0;
    const double worst = worst_error(
        intrinsics, {320, 240},
        [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
          const double r = p.norm(), angle = std::atan(r);
          double bent = angle;
          for (std::size_t i = 0; i < k.size(); ++i) bent += k[i] * std::pow(angle, 3 + 2 * static_cast<double>(i));
          return r > 0 ? Eigen::Vector2d(p * bent / r) : p;
        },
        asked);
    EXPECT_LE(worst, 0.5 + 1e-9);
    EXPECT_EQ(asked, 320 * 240) << "the ideal image is a part of what the lens sees";
  }
}

TEST(Undistorted, ThinPrismsAndTiltAreOpenCvs) {
  const std::vector<double> c{-0.2,  0.05,  0.001,  -0.002, 0.01,  0.02, -0.01,
                              0.003, 0.004, -0.002, 0.003,  0.001, 0.03, -0.02};
  const Intrinsics intrinsics{
      .fx = 300, .fy = 300, .cx = 159.5, .cy = 119.5, .resolution = std::nullopt, .distortion = c};
  int asked = 0;
  const double worst = worst_error(
      intrinsics, {320, 240},
      [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
        const double x = p.x(), y = p.y(), r2 = p.squaredNorm(), r4 = r2 * r2, r6 = r4 * r2;
        const double radial = (1 + c[0] * r2 + c[1] * r4 + c[4] * r6) / (1 + c[5] * r2 + c[6] * r4 + c[7] * r6);
        const double xd = x * radial + 2 * c[2] * x * y + c[3] * (r2 + 2 * x * x) + c[8] * r2 + c[9] * r4;
        const double yd = y * radial + c[2] * (r2 + 2 * y * y) + 2 * c[3] * x * y + c[10] * r2 + c[11] * r4;
        const double sx = std::sin(c[12]), cx = std::cos(c[12]), sy = std::sin(c[13]), cy = std::cos(c[13]);
        // The matrix of OpenCV's documentation, written out.
        Mat3 tilt;
        tilt << cy, sx * sy, -sy * cx, 0, cx, sx, sy, -cy * sx, cy * cx;
        Mat3 project;
        project << tilt(2, 2), 0, -tilt(0, 2), 0, tilt(2, 2), -tilt(1, 2), 0, 0, 1;
        const Vec3 image = project * tilt * Vec3(xd, yd, 1);
        return {image.x() / image.z(), image.y() / image.z()};
      },
      asked);
  EXPECT_LE(worst, 0.5 + 1e-9);
  EXPECT_GT(asked, 60'000);
}

TEST(Undistorted, BeyondTheRadiusWhereThePolynomialTurnsBackNothingIsKnown) {
  // r (1 - 0.3 r^2) grows up to r = 1.054 and comes back to the middle of the image after that.
  const Intrinsics intrinsics{
      .fx = 75, .fy = 75, .cx = 159.5, .cy = 119.5, .resolution = std::nullopt, .distortion = {-0.3}};
  const std::vector<std::int32_t> sources = distorted_pixels(intrinsics, {320, 240});
  const double turn = 1 / std::sqrt(0.9);
  int inside = 0, outside = 0;
  for (int row = 0; row < 240; ++row) {
    for (int column = 0; column < 320; ++column) {
      const double radius = std::hypot((column - 159.5) / 75, (row - 119.5) / 75);
      const bool is_known = sources[static_cast<std::size_t>(row * 320 + column)] >= 0;
      if (radius > turn) {
        EXPECT_FALSE(is_known) << column << ' ' << row;
        ++outside;
      } else if (radius < turn - 0.005) {
        EXPECT_TRUE(is_known) << column << ' ' << row;
        ++inside;
      }
    }
  }
  EXPECT_GT(inside, 10'000);
  EXPECT_GT(outside, 10'000);
}

}  // namespace
}  // namespace vantage
