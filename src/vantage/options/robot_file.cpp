#include "vantage/options/robot_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "vantage/arm/arm.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/files/yaml_text.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/robot/free_flyer.hpp"
#include "vantage/robot/gantry.hpp"
#include "vantage/robot/turntable.hpp"

namespace vantage {
namespace {

/// Former ones too.
std::vector<std::string> names_of(const std::vector<OptionField>& fields) {
  std::vector<std::string> names;
  for (const OptionField& field : fields) {
    names.push_back(field.name);
    for (const FormerName& former : field.former) names.push_back(former.name);
  }
  return names;
}

/// As many numbers as the arm has joints.
Eigen::VectorXd joint_values(const std::string& option, const std::string& text, std::size_t joints) {
  const std::vector<double> values = numbers_from_text(option, text, joints);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

using Packages = std::map<std::string, std::filesystem::path>;

/// Texts that are separated by ';', without blanks around them and without empty ones.
std::vector<std::string> pieces_of(const std::string& text) {
  std::vector<std::string> pieces;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::string_view piece = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(piece.size() + 1, rest.size()));
    if (!trimmed(piece).empty()) pieces.emplace_back(trimmed(piece));
  }
  return pieces;
}

/// The file that a URDF in `folder` names.
std::filesystem::path mesh_path(const std::filesystem::path& folder, const std::string& file,
                                const Packages& packages) {
  constexpr std::string_view of_package = "package://", of_file = "file://";
  if (file.starts_with(of_file)) return file.substr(of_file.size());
  if (!file.starts_with(of_package)) {
    require(file.find("://") == std::string::npos, "the mesh '", file,
            "' is named by a URL; must be a path seen from the URDF's folder, or package://NAME/PATH");
    return folder / file;
  }
  const std::string rest = file.substr(of_package.size());
  const std::string name = rest.substr(0, rest.find('/'));
  const auto found = packages.find(name);
  require(found != packages.end(), "the mesh '", file, "' is in a package; say where it is: --package ", name,
          "=FOLDER (or 'package' in the robot's file)");
  return found->second / rest.substr(std::min(name.size() + 1, rest.size()));
}

Box3 mesh_extent(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  require(ending != ".dae", "the mesh ", path.string(),
          ": COLLADA is not read; convert it to .stl, .obj, .ply or .off (assimp export IN.dae OUT.stl) and name that");
  Box3 extent;
  for (const Vec3& vertex : read_mesh(path).vertices) extent.extend(vertex);
  return extent;
}

std::vector<std::pair<std::string, std::string>> link_pairs(const std::string& text) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string& piece : pieces_of(text)) {
    const std::size_t blank = std::min(piece.find_first_of(" \t"), piece.size());
    const std::string second(trimmed(std::string_view(piece).substr(blank)));
    require(!second.empty() && second.find_first_of(" \t") == std::string::npos, "may-touch = '", piece,
            "': must be two links, LINK LINK; several pairs are separated by ';'");
    pairs.emplace_back(piece.substr(0, blank), second);
  }
  return pairs;
}

std::shared_ptr<const RobotModel> make_arm(const RobotDescription& robot, const std::filesystem::path& folder,
                                           const Packages& packages) {
  require(!robot.urdf.empty(), "urdf: must name the arm's URDF");
  const std::filesystem::path file = folder / robot.urdf;
  ArmDescription arm = arm_from_urdf(read_file(file), file.string(), robot.sensor_link, [&](const std::string& mesh) {
    return mesh_extent(mesh_path(file.parent_path(), mesh, packages));
  });
  ArmOptions options;
  options.padding = robot.padding;
  options.seed = robot.path_seed;
  options.most_nodes = robot.path_nodes;
  if (robot.may_touch) options.may_touch = link_pairs(*robot.may_touch);
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
                                             const std::filesystem::path& folder, const Packages& packages) {
  if (robot.kind == "arm") return make_arm(robot, folder, packages);
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

std::map<std::string, std::filesystem::path> packages_from_text(const std::string& text) {
  Packages packages;
  for (const std::string& piece : pieces_of(text)) {
    const std::size_t equals = piece.find('=');
    require(equals != std::string::npos && equals > 0 && equals + 1 < piece.size(), "package = '", piece,
            "': must be NAME=FOLDER; several are separated by ';'");
    const bool is_new = packages
                            .emplace(trimmed(std::string_view(piece).substr(0, equals)),
                                     trimmed(std::string_view(piece).substr(equals + 1)))
                            .second;
    require(is_new, "package = '", piece, "': the package has a folder already");
  }
  return packages;
}

std::string absolute_packages(const std::string& text, const std::filesystem::path& from) {
  std::string result;
  for (const auto& [name, folder] : packages_from_text(text)) {
    result += concat(result.empty() ? "" : ";", name, "=",
                     std::filesystem::absolute(from / folder).lexically_normal().string());
  }
  return result;
}

std::vector<std::string> robot_option_names(const std::string& kind) {
  if (kind == "free-flyer") return {"kind"};
  if (kind == "gantry") return {"kind", "axes", "pan", "tilt", "turn-cost"};
  if (kind == "turntable") {
    return {"kind", "arc-center", "arc-radius", "arc-tolerance", "arc", "turn", "turn-weights"};
  }
  require(kind == "arm", "kind = '", kind, "': must be one of: free-flyer, gantry, turntable, arm");
  return {"kind",          "urdf",    "sensor-link", "base-position", "base-rotation", "home",
          "joint-weights", "padding", "path-seed",   "path-nodes",    "may-touch"};
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

std::vector<std::string> load_robot(ReconstructOptions& options, const std::set<std::string>& given) {
  if (!options.robot) return {};
  return set_robot(options, read_file(*options.robot), *options.robot, given);
}

std::vector<std::string> set_robot(ReconstructOptions& options, const std::string& text,
                                   const std::filesystem::path& file, const std::set<std::string>& given) {
  const std::string name = file.string();
  // A full disk leaves such files: a robot without limits is not what anybody means by one.
  require(!parse_yaml(text, name).IsNull(), name, ": says nothing; must say at least `kind: free-flyer`");

  RobotDescription robot;
  const std::vector<OptionField> all = option_fields(robot);
  std::vector<OptionField> of_program = option_fields(options);
  std::erase_if(of_program, [](const OptionField& field) { return field.name == "robot"; });
  std::vector<std::string> known = names_of(all);
  for (const std::string& each : names_of(of_program)) known.push_back(each);
  set_options_from_yaml(fields_named(all, {"kind"}), text, name, known);
  try {
    const std::vector<OptionField> of_kind = fields_named(all, robot_option_names(robot.kind));
    std::vector<std::string> hints = set_options_from_yaml(of_kind, text, name, names_of(of_program));
    known = names_of(of_kind);
    known.insert(known.end(), given.begin(), given.end());
    for (const std::string& each : names_of(fields_named(of_program, {given.begin(), given.end()})))
      known.push_back(each);
    std::erase_if(of_program, [&given](const OptionField& field) { return given.contains(field.name); });
    for (std::string& hint : set_options_from_yaml(of_program, text, name, known)) hints.push_back(std::move(hint));
    // What the file itself says is seen from the file.
    if (options.package && !given.contains("package"))
      options.package = absolute_packages(*options.package, file.parent_path());
    options.robot_model = make_robot(robot, options.reach_options(), file.parent_path(),
                                     options.package ? packages_from_text(*options.package) : Packages{});
    return hints;
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.starts_with(name)) throw;
    throw InputError(with_place(message, text, name));
  }
}

}  // namespace vantage
