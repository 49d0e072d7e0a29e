#include "vantage/model/kept_scan.hpp"

#include <gtest/gtest.h>

#include "vantage/core/random.hpp"

namespace vantage {
namespace {

KeptScan kept(const Scan& scan) { return {scan, std::make_shared<ScratchFile>()}; }

RangeImage image_of(int columns, int rows, Random& random, double share_of_hits) {
  RangeImage image{camera_from_apertures(radians(45), radians(40), {columns, rows}), {}};
  image.camera.max_depth = 4;
  for (int i = 0; i < columns * rows; ++i) {
    const double draw = random.uniform();
    const float missed = random.uniform() < 0.5 ? RangeImage::unknown : RangeImage::no_return;
    image.depth.push_back(draw < share_of_hits ? static_cast<float>(1 + random.uniform()) : missed);
  }
  return image;
}

TEST(KeptScan, ComesBackToTheLastBit) {
  Random random(1, 0);
  for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    for (int i = 0; i < 20; ++i) {
      const RangeImage image = image_of(1 + random.index(30), 1 + random.index(20), random, share);
      const Scan scan = scan_of(image);
      const Scan again = kept(scan).scan();
      EXPECT_EQ(std::get<ImageScan>(again).image.depth, image.depth);
      EXPECT_EQ(std::get<ImageScan>(again).normals, std::get<ImageScan>(scan).normals);
      EXPECT_EQ(std::get<ImageScan>(again).image.camera.max_depth, 4);
    }
  }
}

TEST(KeptScan, WhatWasNotMetTakesNoMemory) {
  RangeImage image{camera_from_apertures(radians(45), radians(45), {320, 240}), {}};
  image.depth.assign(320 * 240, RangeImage::no_return);
  for (std::size_t i = 0; i < 1000; ++i) image.depth[30000 + i] = 1 + 0.001F * static_cast<float>(i);
  EXPECT_LT(kept(scan_of(image)).bytes(), 4100U);
}

TEST(KeptScan, KeepsPointsWithTheirOrigins) {
  PointScan points;
  points.points = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
  points.normals = {Vec3f(0, 0, -1), Vec3f(0, 0, 0)};
  points.origins = {Vec3(0.1, 0, 0)};
  const Scan again = kept(points).scan();
  EXPECT_EQ(std::get<PointScan>(again).points, points.points);
  EXPECT_EQ(std::get<PointScan>(again).normals, points.normals);
  EXPECT_EQ(std::get<PointScan>(again).origins, points.origins);
}

}  // namespace
}  // namespace vantage
