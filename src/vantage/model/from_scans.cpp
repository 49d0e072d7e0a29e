#include "vantage/model/from_scans.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "vantage/core/error.hpp"
#include "vantage/core/order_statistics.hpp"

namespace vantage {
namespace {

constexpr int default_voxels_along_box = 55;           // as in the paper
constexpr double least_radius = 1e-6, farthest = 1e6;  // metres, as for the scene
constexpr double margin = 0.05;                        // around all points, as a share of their extent

Box3 box_around(const std::vector<PendingScan>& scans) {
  Box3 box;
  for (const PendingScan& scan : scans) {
    for (const Vec3& point : points_of(scan.read()).points) box.extend(scan.believed.world_from_sensor * point);
  }
  require(!box.isEmpty(), "scans: none of the ", scans.size(), " scans has a single measured point");
  const Vec3 grown = margin * box.sizes();
  return {box.min() - grown, box.max() + grown};
}

std::size_t bytes_of(const Scan& scan) {
  if (const auto* image = std::get_if<ImageScan>(&scan))
    return image->image.depth.size() * sizeof(float) + image->normals.size() * sizeof(Vec3f);
  const auto& points = std::get<PointScan>(scan);
  return (points.points.size() + points.origins.size()) * sizeof(Vec3) + points.normals.size() * sizeof(Vec3f);
}

/// A scan between its first and its second reading.
class ScanReadTwice {
 public:
  ScanReadTwice(std::function<Scan()> read, std::shared_ptr<std::size_t> bytes_left)
      : read_(std::move(read)), bytes_left_(std::move(bytes_left)) {}

  Scan read() {
    if (std::optional<Scan> scan = std::exchange(kept_, std::nullopt)) {
      *bytes_left_ += bytes_of(*scan);
      return *std::move(scan);
    }
    Scan scan = read_();
    if (const std::size_t bytes = bytes_of(scan); !was_read_ && bytes <= *bytes_left_) {
      *bytes_left_ -= bytes;
      kept_ = scan;
    }
    was_read_ = true;
    return scan;
  }

 private:
  std::function<Scan()> read_;
  std::shared_ptr<std::size_t> bytes_left_;
  std::optional<Scan> kept_;
  bool was_read_ = false;
};

}  // namespace

std::vector<PendingScan> kept_for_second_reading(std::vector<PendingScan> scans, std::size_t most_bytes) {
  const auto bytes_left = std::make_shared<std::size_t>(most_bytes);
  for (PendingScan& scan : scans)
    scan.read = [kept = std::make_shared<ScanReadTwice>(std::move(scan.read), bytes_left)] { return kept->read(); };
  return scans;
}

void ScanPlanOptions::validate() const {
  SensorOptions::validate();
  if (box) {
    require((box->tail<3>().array() > 0).all(), "box = ", box->transpose(),
            ": the sizes (last three) must be positive");
  }
  require(!voxel || *voxel > 0, "voxel = ", voxel.value_or(0), " m: must be positive");
  require(!radius || (*radius >= least_radius && *radius <= farthest), "radius = ", radius.value_or(0),
          " m: must be within ", least_radius, " and ", farthest, " m");
  require(pose_error > 0, "pose-error = ", pose_error, " m: must be positive; use registration none for exact poses");
  require(pose_angle_error > 0 && pose_angle_error <= 90, "pose-angle-error = ", pose_angle_error,
          " degrees: must be in (0, 90]");
  require(surroundings >= 0, "surroundings = ", surroundings, ": must not be negative");
  require(registration == "icp" || registration == "none", "registration = '", registration,
          "': must be icp or none (the truth is known in simulation only)");
}

Vec3 sensor_position(const Scan& scan, const View& view) {
  const auto* lines = std::get_if<PointScan>(&scan);
  if (lines == nullptr || lines->origins.empty()) return view.position();
  Vec3 sum = Vec3::Zero();
  for (const Vec3& origin : lines->origins) sum += origin;
  return view.world_from_sensor * Vec3(sum / static_cast<double>(lines->origins.size()));
}

std::optional<Box3> given_box(const ScanPlanOptions& options) {
  if (!options.box) return std::nullopt;
  const Vec3 center = options.box->head<3>();
  const Vec3 half = 0.5 * options.box->tail<3>();
  return Box3(center - half, center + half);
}

ScanScene scene_in(const Box3& box, const ScanPlanOptions& options) {
  ScanScene fitted;
  fitted.scene.center = box.center();
  fitted.scene.voxel_length = options.voxel.value_or(box.sizes().maxCoeff() / default_voxels_along_box);
  const Vec3 voxels = (box.sizes() / fitted.scene.voxel_length).array() - 1e-9;
  require(voxels.maxCoeff() < 1e6, "box of ", box.sizes().transpose(), " m with voxels of ", fitted.scene.voxel_length,
          " m does not fit in memory: use longer voxels");
  fitted.scene.enclosure_size = voxels.array().ceil().matrix().cast<int>().cwiseMax(1);
  fitted.scene.scene_size = fitted.scene.enclosure_size;
  fitted.scene.rule = options.map;
  fitted.scene.validate();
  fitted.sensor = options;

  const Vec3 around = Vec3::Constant(options.surroundings * box.sizes().maxCoeff());
  fitted.region = Box3(box.min() - around, box.max() + around);
  if (options.radius) fitted.radius = *options.radius;
  return fitted;
}

std::size_t points_in(const Box3& box, const Scan& scan, const View& believed) {
  const std::vector<Vec3> points = points_of(scan).points;
  return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](const Vec3& point) {
    return box.contains(believed.world_from_sensor * point);
  }));
}

double typical_distance(std::vector<double> distances) { return distances.empty() ? 0 : median(std::move(distances)); }

ScanScene fit_scene(const std::vector<PendingScan>& scans, const ScanPlanOptions& options) {
  options.validate();
  require(!scans.empty(), "scans: there are none");
  const std::optional<Box3> given = given_box(options);
  const Box3 box = given ? *given : box_around(scans);
  // A box around all points has some.
  const bool has_points = !given || std::any_of(scans.begin(), scans.end(), [&](const PendingScan& pending) {
    return points_in(box, pending.read(), pending.believed) > 0;
  });
  require(has_points, "box: none of the ", scans.size(), " scans has a point in the box around (",
          box.center().transpose(), ") of size (", box.sizes().transpose(),
          ") m; `vantage doctor` tells whether poses, units or the box are wrong");
  return scene_in(box, options);
}

}  // namespace vantage
