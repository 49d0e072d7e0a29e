#include "vantage/options/robot_file.hpp"

#include <algorithm>

#include "vantage/arm/arm.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/robot/free_flyer.hpp"
#include "vantage/robot/gantry.hpp"
#include "vantage/robot/turntable.hpp"

namespace vantage {
namespace {

std::vector<std::string> names_of(const std::vector<OptionField>& fields) {
  std::vector<std::string> names;
  for (const OptionField& field : fields) names.push_back(field.name);
  return names;
}

/// As many numbers as the arm has joints.
Eigen::VectorXd joint_values(const std::string& option, const std::string& text, std::size_t joints) {
  const std::vector<double> values = numbers_from_text(option, text, joints);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Box3 mesh_extent(const std::filesystem::path& folder, const std::string& file) {
  require(file.find("://") == std::string::npos, "urdf: the mesh '", file,
          "' is named by a URL; must be a path seen from the URDF's folder");
  Box3 extent;
  for (const Vec3& vertex : read_mesh(folder / file).vertices) extent.extend(vertex);
  return extent;
}

std::shared_ptr<const RobotModel> make_arm(const RobotDescription& robot, const std::filesystem::path& folder) {
  require(!robot.urdf.empty(), "urdf: must name the arm's URDF");
  const std::filesystem::path file = folder / robot.urdf;
  ArmDescription arm =
      arm_from_urdf(read_file(file), file.string(), robot.sensor_link,
                    [&file](const std::string& mesh) { return mesh_extent(file.parent_path(), mesh); });
  ArmOptions options;
  options.padding = robot.padding;
  options.seed = robot.path_seed;
  options.most_nodes = robot.path_nodes;
  const Vec3 angles = robot.base_rotation * (std::numbers::pi / 180);
  options.world_from_base = Eigen::Translation3d(robot.base_position) * Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) *
                            Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) * Eigen::AngleAxisd(angles.x(), Vec3::UnitX());
  if (robot.home) {
    options.home = joint_values("home", *robot.home, arm.joints.size());
    for (std::size_t j = 0; j < arm.joints.size(); ++j) {
      if (arm.joints[j].kind == ArmJoint::Kind::revolute) {
        options.home[static_cast<Eigen::Index>(j)] = radians(options.home[static_cast<Eigen::Index>(j)]);
      }
    }
  }
  if (robot.joint_weights) options.weights = joint_values("joint-weights", *robot.joint_weights, arm.joints.size());
  return std::make_shared<Arm>(std::move(arm), options);
}

std::shared_ptr<const RobotModel> make_robot(const RobotDescription& robot, const ReachOptions& reach,
                                             const std::filesystem::path& folder) {
  if (robot.kind == "arm") return make_arm(robot, folder);
  if (robot.kind == "gantry") {
    return std::make_shared<Gantry>(GantryOptions{.axes = Box3(Vec3(robot.axes.head<3>()), Vec3(robot.axes.tail<3>())),
                                                  .pan = robot.pan,
                                                  .tilt = robot.tilt,
                                                  .head_radius = reach.body_radius,
                                                  .turn_cost = robot.turn_cost});
  }
  if (robot.kind == "turntable") {
    return std::make_shared<Turntable>(TurntableOptions{.center = robot.arc_center,
                                                        .radius = robot.arc_radius,
                                                        .arc = robot.arc,
                                                        .turn = robot.turn,
                                                        .head_radius = reach.body_radius,
                                                        .tolerance = robot.arc_tolerance,
                                                        .weights = robot.turn_weights});
  }
  return std::make_shared<FreeFlyer>(reach);
}

/// "FILE, line N: MESSAGE" where the message begins with the name of an option that the file holds.
std::string with_place(const std::string& message, const std::string& text, const std::string& name) {
  const std::string option = message.substr(0, message.find_first_of(": ="));
  TextReader lines(text, name);
  for (int line = 1; lines.next_line(); ++line) {
    if (lines.rest_of_line().starts_with(option + ":")) return concat(name, ", line ", line, ": ", message);
  }
  return concat(name, ": ", message);
}

}  // namespace

std::vector<std::string> robot_option_names(const std::string& kind) {
  if (kind == "free-flyer") return {"kind"};
  if (kind == "gantry") return {"kind", "axes", "pan", "tilt", "turn-cost"};
  if (kind == "turntable") {
    return {"kind", "arc-center", "arc-radius", "arc-tolerance", "arc", "turn", "turn-weights"};
  }
  require(kind == "arm", "kind = '", kind, "': must be one of: free-flyer, gantry, turntable, arm");
  return {"kind", "urdf",          "sensor-link", "base-position", "base-rotation",
          "home", "joint-weights", "padding",     "path-seed",     "path-nodes"};
}

std::vector<OptionField> noting(std::vector<OptionField> fields, std::set<std::string>& given) {
  for (OptionField& field : fields) {
    field.set = [set = field.set, name = field.name, &given](std::string_view text) {
      given.insert(name);
      return set(text);
    };
  }
  return fields;
}

void load_robot(ReconstructOptions& options, const std::set<std::string>& given) {
  if (options.robot) set_robot(options, read_file(*options.robot), *options.robot, given);
}

void set_robot(ReconstructOptions& options, const std::string& text, const std::filesystem::path& file,
               const std::set<std::string>& given) {
  const std::string name = file.string();

  RobotDescription robot;
  const std::vector<OptionField> all = option_fields(robot);
  std::vector<OptionField> of_program = option_fields(options);
  std::erase_if(of_program, [](const OptionField& field) { return field.name == "robot"; });
  std::vector<std::string> known = names_of(all);
  for (const std::string& each : names_of(of_program)) known.push_back(each);
  set_options_from_yaml(fields_named(all, {"kind"}), text, name, known);
  try {
    const std::vector<OptionField> of_kind = fields_named(all, robot_option_names(robot.kind));
    set_options_from_yaml(of_kind, text, name, names_of(of_program));
    known = names_of(of_kind);
    known.insert(known.end(), given.begin(), given.end());
    std::erase_if(of_program, [&given](const OptionField& field) { return given.contains(field.name); });
    set_options_from_yaml(of_program, text, name, known);
    options.robot_model = make_robot(robot, options.reach_options(), file.parent_path());
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.starts_with(name)) throw;
    throw InputError(with_place(message, text, name));
  }
}

}  // namespace vantage
