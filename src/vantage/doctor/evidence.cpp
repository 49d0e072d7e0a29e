#include "vantage/doctor/evidence.hpp"

#include <algorithm>

namespace vantage {
namespace {

constexpr std::size_t most_points = 4000;  // of a frame: a point every few pixels, more than an outline needs

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void count_pixels(FrameEvidence& frame, const RangeImage& image, double far_limit) {
  std::size_t unknown = 0, no_return = 0;
  for (const float depth : image.depth) {
    unknown += depth == RangeImage::unknown ? 1 : 0;
    no_return += depth > far_limit ? 1 : 0;
  }
  frame.unknown = static_cast<double>(unknown) / static_cast<double>(image.depth.size());
  frame.no_return = static_cast<double>(no_return) / static_cast<double>(image.depth.size());
}

/// The points of an image on a coarse grid of pixels, so that no part of it is left out.
PointCloud thinned(const ImageScan& scan) {
  const RangeImage& image = scan.image;
  const Resolution size = image.camera.resolution;
  int step = 1;
  while (static_cast<std::size_t>(size.rays() / (step * step)) > most_points) ++step;
  const RayGrid rays = image.camera.rays();
  PointCloud cloud;
  for (int row = step / 2; row < size.rows; row += step) {
    for (int column = step / 2; column < size.columns; column += step) {
      const float depth = image.at(column, row);
      if (!RangeImage::is_hit(depth)) continue;
      const auto pixel =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(size.columns) + static_cast<std::size_t>(column);
      cloud.add(point_in_sensor(rays, column, row, depth), scan.normals[pixel].cast<double>());
    }
  }
  return cloud;
}

PointCloud thinned(const PointScan& scan) {
  const std::size_t step = scan.points.size() / most_points + 1;
  PointCloud cloud;
  for (std::size_t i = 0; i < scan.points.size(); i += step) {
    cloud.add(scan.points[i], scan.normals.empty() ? Vec3(Vec3::Zero()) : scan.normals[i].cast<double>());
  }
  return cloud;
}

}  // namespace

std::vector<Pose> Evidence::poses() const {
  std::vector<Pose> result;
  for (const FrameEvidence& frame : frames) result.push_back(frame.world_from_sensor);
  return result;
}

double Evidence::median_depth() const {
  std::vector<double> depths;
  for (const FrameEvidence& frame : frames) {
    if (frame.median_depth > 0) depths.push_back(frame.median_depth);
  }
  return median(std::move(depths));
}

Evidence gather(const ScanSet& set, double far_limit, const std::function<void(std::size_t, std::size_t)>& progress) {
  Evidence evidence;
  evidence.camera = set.camera;
  for (const ScanFile& file : set.scans) {
    FrameEvidence frame;
    frame.name = file.name;
    frame.world_from_sensor = file.view.world_from_sensor;
    const Scan scan = file.read();
    if (const auto* image = std::get_if<ImageScan>(&scan)) {
      count_pixels(frame, image->image, far_limit);
      frame.cloud = thinned(*image);
    } else {
      frame.cloud = thinned(std::get<PointScan>(scan));
    }
    std::vector<double> depths;
    for (const Vec3& point : frame.cloud.points) depths.push_back(point.norm());
    frame.median_depth = median(std::move(depths));
    evidence.frames.push_back(std::move(frame));
    progress(evidence.frames.size(), set.scans.size());
  }
  return evidence;
}

}  // namespace vantage
