#include "vantage/doctor/evidence.hpp"

#include <algorithm>

#include "vantage/core/order_statistics.hpp"
#include "vantage/recordings/scan_bytes.hpp"

namespace vantage {
namespace {

constexpr std::size_t most_frames_gathered = 300;
constexpr std::size_t most_points = 4000;  // of a frame: a point every few pixels, more than an outline needs

double median_or_0(std::vector<double> values) { return values.empty() ? 0 : upper_median(std::move(values)); }

/// Whether more of the pixels around this one have met something than not.
bool is_among_hits(const RangeImage& image, int column, int row) {
  int hits = 0, others = 0;
  for (int v = std::max(0, row - 1); v <= std::min(image.camera.resolution.rows - 1, row + 1); ++v) {
    for (int u = std::max(0, column - 1); u <= std::min(image.camera.resolution.columns - 1, column + 1); ++u) {
      if (u == column && v == row) continue;
      ++(RangeImage::is_hit(image.at(u, v)) ? hits : others);
    }
  }
  return hits > others;
}

/// Of the pixels that met nothing, the share that lies among hits: background is in one piece, dropouts are strewn.
double strewn_share(const RangeImage& image) {
  std::size_t strewn = 0, all = 0;
  for (int row = 0; row < image.camera.resolution.rows; ++row) {
    for (int column = 0; column < image.camera.resolution.columns; ++column) {
      if (image.at(column, row) != RangeImage::no_return) continue;
      ++all;
      strewn += is_among_hits(image, column, row) ? 1 : 0;
    }
  }
  return all == 0 ? 0 : static_cast<double>(strewn) / static_cast<double>(all);
}

void count_pixels(FrameEvidence& frame, const RangeImage& image, double far_limit) {
  std::size_t unknown = 0, no_return = 0;
  for (const float depth : image.depth) {
    unknown += depth == RangeImage::unknown ? 1 : 0;
    no_return += depth > far_limit ? 1 : 0;
  }
  frame.unknown = static_cast<double>(unknown) / static_cast<double>(image.depth.size());
  frame.no_return = static_cast<double>(no_return) / static_cast<double>(image.depth.size());
  frame.strewn = strewn_share(image);
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
  return median_or_0(std::move(depths));
}

Evidence gather(const ScanSet& set, double far_limit, const ScanFolderOptions& options,
                const std::function<void(std::size_t, std::size_t)>& progress) {
  Evidence evidence;
  evidence.camera = set.camera;
  evidence.every = std::max<std::size_t>(1, (set.scans.size() + most_frames_gathered - 1) / most_frames_gathered);
  for (std::size_t i = 0; i < set.scans.size(); i += evidence.every) {
    const ScanFile& file = set.scans[i];
    FrameEvidence frame;
    frame.name = file.name;
    frame.world_from_sensor = file.view.world_from_sensor;
    frame.is_masked = file.is_masked;
    Scan whole = file.read();
    if (const auto* image = std::get_if<ImageScan>(&whole)) count_pixels(frame, image->image, far_limit);
    const Scan scan = cropped(std::move(whole), file.view, options);
    if (const auto* image = std::get_if<ImageScan>(&scan)) {
      frame.cloud = thinned(*image);
      frame.map = DepthMap(image->image);
    } else {
      const auto& lines = std::get<PointScan>(scan);
      frame.cloud = thinned(lines);
      // Of a line scanner, whose sight lines have many origins, directions from one of them say nothing.
      if (lines.origins.size() == 1 && lines.axis == Vec3::UnitZ()) frame.map = DepthMap(frame.cloud.points);
    }
    std::vector<double> depths;
    for (const Vec3& point : frame.cloud.points) depths.push_back(point.norm());
    frame.median_depth = median_or_0(std::move(depths));
    if (frame.cloud.points.empty()) {
      evidence.empty.push_back(frame.name);
    } else {
      evidence.frames.push_back(std::move(frame));
    }
    progress(i + 1, set.scans.size());
  }
  return evidence;
}

}  // namespace vantage
