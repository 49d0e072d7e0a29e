#pragma once

#include <functional>
#include <string>

#include "vantage/model/reconstruction.hpp"
#include "vantage/model/sensor_options.hpp"

namespace vantage {

/// Planning on scans of a real sensor: where the object is and how finely to look.
struct ScanPlanOptions : SensorOptions {
  std::optional<Eigen::Matrix<double, 6, 1>> box;  // cx cy cz sx sy sz, metres; around all points if not given
  std::optional<double> voxel;                     // metres; the longest side of the box over 55 if not given
  std::optional<double> radius;      // of the view sphere, metres; the sensor's median distance if not given
  int views = 80;                    // on the view sphere
  std::string registration = "icp";  // icp or none
  double pose_angle_error = 5;       // degrees
  static constexpr double default_pose_error = 0.05;  // metres
  double pose_error = default_pose_error;             // metres; poses are off by no more than this
  double surroundings = 0.5;  // around the box, as a share of its longest side: what registration may use

  void validate() const;
};

template <class Field>
void describe(ScanPlanOptions& o, Field&& field) {
  field("box", o.box, "m", "where the object is: cx,cy,cz,sx,sy,sz; around all points if not given");
  field("voxel", o.voxel, "m", "edge of a voxel; the longest side of the box over 55 if not given");
  field("radius", o.radius, "m",
        "of the view sphere; the sensor's median distance from the box at merged scans if not given");
  field("views", o.views, "", "candidates on the view sphere: 20*4^k");
  field("registration", o.registration, "", "icp, or none to take the poses as they are");
  field("pose-error", o.pose_error, "m", "how far off the poses may be at most");
  field("pose-angle-error", o.pose_angle_error, "degrees", "how far turned the poses may be at most");
  field("surroundings", o.surroundings, "box sides",
        "how far around the box things stand still, so that registration may use them");
  describe(static_cast<SensorOptions&>(o), field);
}

/// A scan that is still on disk, with the pose that the robot gave it.
struct PendingScan {
  std::string name;
  View believed;
  std::function<Scan()> read;
};

/// The same scans, each kept in memory from its first reading to its second one while `most_bytes` are enough for all
/// that are kept: a scene is fitted to scans before they are merged, and each is decoded once. Not for several threads.
[[nodiscard]] std::vector<PendingScan> kept_for_second_reading(std::vector<PendingScan> scans,
                                                               std::size_t most_bytes = std::size_t{128} << 20U);

/// Box, voxels and view sphere that fit the scans.
struct ScanScene {
  SceneOptions scene;
  double radius = 1;  // metres; where the options give none, the distance of the sensor at the scans once merged
  Box3 region;        // what registration uses: the box and its surroundings
  SensorOptions sensor;

  [[nodiscard]] Candidates candidates(int views) const { return view_sphere(views, radius, scene.center); }
};

/// Where the sensor stood: the middle of its sight lines' origins.
[[nodiscard]] Vec3 sensor_position(const Scan& scan, const View& view);

/// The scene in a box, with the voxels and surroundings of the options; its radius is theirs too, where they give one.
[[nodiscard]] ScanScene scene_in(const Box3& box, const ScanPlanOptions& options);
/// The box of the options, if they give one.
[[nodiscard]] std::optional<Box3> given_box(const ScanPlanOptions& options);
/// Number of the scan's points in the box, by the believed pose.
[[nodiscard]] std::size_t points_in(const Box3& box, const Scan& scan, const View& believed);

/// The median of distances between box and sensor, which a scan with a wrong pose hardly moves; 0 where there are none.
[[nodiscard]] double typical_distance(std::vector<double> distances);

/// Fits the scene to the options and, where they give no box, to the scans, which are then read once. Else scans are
/// read until one has a point in the box; throws InputError where none has.
[[nodiscard]] ScanScene fit_scene(const std::vector<PendingScan>& scans, const ScanPlanOptions& options);

}  // namespace vantage
