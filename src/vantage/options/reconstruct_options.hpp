#pragma once

#include <memory>
#include <optional>
#include <string>

#include "vantage/files/option_text.hpp"
#include "vantage/model/reconstruction.hpp"
#include "vantage/model/sensor_options.hpp"
#include "vantage/options/error_options.hpp"
#include "vantage/planning/planner.hpp"

namespace vantage {

/// All that decides a simulated reconstruction; together with the object it can be repeated bit for bit. Texts and
/// units are those of the command line and of config.yaml: metres, degrees.
struct ReconstructOptions : ErrorOptions {
  std::optional<double> size;
  std::uint64_t seed = 1;
  int initial_view = 0;

  double voxel = 0.02;
  Index3 scene = Index3::Constant(205);
  Index3 enclosure = Index3::Constant(55);
  Vec3 center = Vec3::Zero();

  std::string camera = "45x45:320x320";
  Eigen::Vector2d depth_range{0, 4.5};
  std::optional<double> max_incidence;
  std::string sensor = "ideal";
  DepthDeviation depth_noise;
  std::optional<double> mixed_pixels;
  FlyingPixelRule flying_pixels = FlyingPixelRule::keep;
  MapRule map = MapRule::paper;
  std::string quality = "axis";

  std::string candidates = "sphere:80:2";
  double body_radius = 0;
  std::optional<std::string> workspace;
  std::optional<std::string> obstacles;
  std::optional<std::string> robot;    // a file; see load_robot
  std::optional<std::string> package;  // see packages_from_text
  std::optional<std::string> travel;
  std::shared_ptr<const RobotModel> robot_model;  // what load_robot made of the file; no option

  std::string search = "exhaustive";
  std::string rays = "sensor";
  int multi_resolution_b = 10;
  std::optional<int> multi_resolution_stages;
  int multi_resolution_columns = 40;

  std::string utility = "combined";
  std::string plan = "view";
  double scan_time = 3;
  double speed = 0.5;
  double alpha_oc = 0.2;
  double alpha_op = 0.8;
  double rho = 0.2;
  bool navigation = true;

  std::string registration = "truth";

  int max_views = 40;
  std::optional<double> max_distance;
  std::optional<double> max_time;
  int stop_occplane = 0;
  double deadline = 0;

  /// Throws InputError naming the option.
  void validate() const;

  [[nodiscard]] SceneOptions scene_options() const;
  [[nodiscard]] RangeCamera range_camera() const;
  /// How the sensor errs.
  [[nodiscard]] SensorModel sensor_model() const;
  [[nodiscard]] PlannerOptions planner_options() const;
  [[nodiscard]] ReachOptions reach_options() const;
  /// What distances are counted in: metres, or radians where the path of an arm or a turntable is asked for.
  [[nodiscard]] std::string travel_unit() const;
  [[nodiscard]] Budget budget() const;
  [[nodiscard]] QualityReference quality_reference() const;
  /// The candidate views around the scene's center.
  [[nodiscard]] Candidates candidate_views() const;
  /// Metres between the points that the fused cloud keeps: a quarter of a voxel.
  [[nodiscard]] double point_spacing() const { return voxel / 4; }
};

/// The names of the utilities, separated by commas.
[[nodiscard]] std::string names_of_utilities();

/// The one description that serves the YAML file, the command line and the documents: name, member, unit, meaning.
template <class Field>
void describe(ReconstructOptions& o, Field&& field) {
  field("size", o.size, "m", "largest side of the object; default 0.815, built-in objects have their own");
  field("seed", o.seed, "", "seed of everything random");
  field("initial-view", o.initial_view, "", "index of the candidate that the first scan is taken from");
  field("voxel", o.voxel, "m", "edge of a voxel");
  field("scene", o.scene, "voxels", "size of the scene");
  field("enclosure", o.enclosure, "voxels", "size of the object's enclosure in the middle of the scene");
  field("center", o.center, "m", "center of the scene in the world");
  field("camera", o.camera, "", "apertures in degrees and pixels, HxV:COLUMNSxROWS");
  field("depth-range", o.depth_range, "m", "nearest and farthest depth along the axis");
  field("max-incidence", o.max_incidence, "degrees",
        "largest angle between a surface's normal and the way back to the sensor; unlimited if not given");
  field("sensor", o.sensor, "", "how the sensor errs: " + names_of_sensors());
  field("depth-noise", o.depth_noise, "m, 1/m, m",
        "A,B or A,B,C: standard deviation of a depth z is A + B z^2 + C tan^2(incidence); where not 0, instead of the "
        "sensor's");
  field("mixed-pixels", o.mixed_pixels, "",
        "share of the pixels at depth edges that measure something in between; the sensor's if not given");
  field("flying-pixels", o.flying_pixels, "", "pixels that no surface around them explains: remove or keep");
  field("map", o.map, "", "how voxels become occupied: paper (by a point, for ever) or evidence");
  field("quality", o.quality, "", "what a point's quality is measured against: axis or ray");
  field("candidates", o.candidates, "", "candidate views: sphere:N:RADIUS or cube:N:SIDE:INNER:OUTER (metres)");
  field("body-radius", o.body_radius, "m", "radius of the robot's body around the sensor");
  field("workspace", o.workspace, "m", "box that the sensor stays in: x0,y0,z0,x1,y1,z1; unlimited if not given");
  field("obstacles", o.obstacles, "m", "solid boxes cx,cy,cz,sx,sy,sz separated by ';'");
  field("robot", o.robot, "", "YAML file of the robot: what it reaches, and what comes with it; see docs/robots.md");
  field("package", o.package, "", "folders of the packages that the robot's URDF names, NAME=FOLDER separated by ';'");
  field("travel", o.travel, "",
        "what moves are counted by: orthodromic, straight or path; by default orthodromic on a sphere, else straight");
  field("search", o.search, "", "exhaustive or multi-resolution");
  field("rays", o.rays, "", "rays of the exhaustive search: sensor, ideal or COLUMNSxROWS");
  field("multi-resolution-b", o.multi_resolution_b, "", "b of eq. 16");
  field("multi-resolution-stages", o.multi_resolution_stages, "", "k; by default the smallest with b^k >= |V|");
  field("multi-resolution-columns", o.multi_resolution_columns, "", "columns of the coarsest stage, R_min");
  field("utility", o.utility, "", "how views are judged: " + names_of_utilities());
  field("plan", o.plan, "",
        "view: the next view by the utility; tour: the fastest tour over the rest of the scan, of which the first view "
        "is "
        "next, as the utility tour");
  field("scan-time", o.scan_time, "s", "of tours: what a scan takes");
  field("speed", o.speed, "m/s", "of tours: how fast the robot moves");
  field("alpha-oc", o.alpha_oc, "", "desired share of occupied voxels, eq. 7");
  field("alpha-op", o.alpha_op, "", "desired share of occplane voxels, eq. 7");
  field("rho", o.rho, "", "navigation factor of the farthest view, eq. 10");
  field("navigation", o.navigation, "", "use the navigation factor");
  describe(static_cast<ErrorOptions&>(o), field);
  field("registration", o.registration, "", "pose of a scan: truth, none (the believed one) or icp");
  field("max-views", o.max_views, "", "stop after this many scans");
  field("max-distance", o.max_distance, "",
        "stop when this much has been travelled, as moves are counted: metres, or radians of an arm's joints");
  field("max-time", o.max_time, "s", "stop after this long");
  field("stop-occplane", o.stop_occplane, "voxels", "stop when no view sees more occplane voxels than this");
  field("deadline", o.deadline, "ms",
        "longest time to evaluate views for one plan: then the best so far is taken, and the run depends on the clock; "
        "0: "
        "no deadline");
}

/// The options that decide how a view is planned on a given map: candidates, camera, utility, search and reach.
[[nodiscard]] std::vector<std::string> planning_option_names();

/// `HxV:CxR`, apertures in degrees.
[[nodiscard]] RangeCamera camera_from_text(const std::string& text);
/// `CxR`.
[[nodiscard]] Resolution resolution_from_text(const std::string& option, const std::string& text);
/// `sensor`, `ideal` or `CxR`.
[[nodiscard]] RayChoice rays_from_text(const std::string& text);

}  // namespace vantage
