#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/options/options.hpp"
#include "vantage/options/reconstruct_options.hpp"

namespace vantage {

/// What a robot's file says besides the program's own options. Each kind of robot knows some of it.
struct RobotDescription {
  std::string kind = "free-flyer";

  std::string urdf;
  std::string sensor_link = "camera";
  Vec3 base_position = Vec3::Zero();
  Vec3 base_rotation = Vec3::Zero();
  std::optional<std::string> home;
  std::optional<std::string> joint_weights;
  double padding = 0.01;
  std::uint64_t path_seed = 1;
  int path_nodes = 2000;
  std::optional<std::string> may_touch;

  Vec3 arc_center = Vec3::Zero();
  double arc_radius = 1;
  double arc_tolerance = 0.001;
  Eigen::Vector2d arc{0, 90};
  Eigen::Vector2d turn{-180, 180};
  Eigen::Vector2d turn_weights{1, 1};

  Eigen::Matrix<double, 6, 1> axes = (Eigen::Matrix<double, 6, 1>() << -1, -1, 0, 1, 1, 2).finished();
  Eigen::Vector2d pan{-180, 180};
  Eigen::Vector2d tilt{-90, 90};
  double turn_cost = 0.1;
};

template <class Field>
void describe(RobotDescription& o, Field&& field) {
  field("kind", o.kind, "", "free-flyer, gantry, turntable or arm");
  field("urdf", o.urdf, "", "arm: its URDF, seen from the robot's file");
  field("sensor-link", o.sensor_link, "", "arm: link whose axes are the sensor's: x right, y down, z forward");
  field("base-position", o.base_position, "m", "arm: of the URDF's root link in the world");
  field("base-rotation", o.base_rotation, "degrees", "arm: roll, pitch, yaw of the root link");
  field("home", o.home, "degrees, m", "arm: joints before the first move; 0 if not given");
  field("joint-weights", o.joint_weights, "", "arm: what a radian (metre) of each joint costs; 1 if not given");
  field("padding", o.padding, "m", "arm: its solids are grown by this");
  field("path-seed", o.path_seed, "", "arm: seed of the search for paths");
  field("may-touch", o.may_touch, "", "arm: links that may touch, LINK LINK; neighbours at a joint always may");
  field("path-nodes", o.path_nodes, "", "arm: places that are tried before the search gives up");
  field("arc-center", o.arc_center, "m", "turntable: what the sensor looks at; on the table's axis");
  field("arc-radius", o.arc_radius, "m", "turntable: distance of the sensor from there");
  field("arc-tolerance", o.arc_tolerance, "m", "turntable: how far off the arc a view may lie");
  field("arc", o.arc, "degrees", "turntable: from where to where the sensor rides, above the horizon");
  field("turn", o.turn, "degrees", "turntable: limits of the table; -180,180 turns without end");
  field("turn-weights", o.turn_weights, "", "turntable: what a radian of the table, and of the arc, costs");
  field("axes", o.axes, "m", "gantry: where the sensor can be: x0,y0,z0,x1,y1,z1");
  field("pan", o.pan, "degrees", "gantry: limits; 0 looks along +x, 90 along +y");
  field("tilt", o.tilt, "degrees", "gantry: limits, above the horizon");
  field("turn-cost", o.turn_cost, "m/rad", "gantry: metres that a radian of pan or tilt counts as");
}

/// Names of what a kind of robot knows, `kind` among them. Throws InputError that lists the kinds.
[[nodiscard]] std::vector<std::string> robot_option_names(const std::string& kind);

/// The folders in a text like `ur_description=/opt/ur; tool=../tool`. Throws InputError that names the option
/// `package`.
[[nodiscard]] std::map<std::string, std::filesystem::path> packages_from_text(const std::string& text);
/// The same text with folders that do not depend on where the program runs; relative ones are seen from `from`.
[[nodiscard]] std::string absolute_packages(const std::string& text, const std::filesystem::path& from);

/// Reads the robot that `options.robot` names into `options.robot_model`; nothing where it names none. Other keys of
/// the file are the program's options: they set those of `options` that are not `given` otherwise. Body radius,
/// workspace and obstacles of the options count for the robot too. Returns a line for people per former name that the
/// file uses. Throws InputError with the file and the line.
std::vector<std::string> load_robot(ReconstructOptions& options, const std::set<std::string>& given = {});

/// The same with the text of the robot's file, which would be called `file`.
std::vector<std::string> set_robot(ReconstructOptions& options, const std::string& text,
                                   const std::filesystem::path& file, const std::set<std::string>& given = {});

/// The same fields, noting in `given` the names of those that are set.
[[nodiscard]] std::vector<OptionField> noting(std::vector<OptionField> fields, std::set<std::string>& given);

}  // namespace vantage
