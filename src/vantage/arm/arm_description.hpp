#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// A simple solid that stands for (a part of) a link.
struct LinkShape {
  enum class Kind { box, cylinder, sphere };
  Kind kind = Kind::box;
  Vec3 size = Vec3::Zero();  // metres; box: edges; cylinder (along z): radius, length; sphere: radius
  Pose joint_from_shape = Pose::Identity();
};

/// A link with its solids. It moves with the frame of a joint, -1: with the base.
struct ArmBody {
  std::string link;
  int joint = -1;
  std::vector<LinkShape> shapes;
};

/// A joint that moves, with its frame relative to that of the joint before it.
struct ArmJoint {
  enum class Kind { revolute, prismatic };
  std::string name;
  Kind kind = Kind::revolute;
  Pose previous_from_joint = Pose::Identity();
  Vec3 axis = Vec3::UnitZ();
  double lower = 0, upper = 0;  // radians or metres
};

/// The chain from a robot's base to its sensor, and all solids that hang on it. Other joints that move (a gripper's)
/// stand still where their position is 0.
struct ArmDescription {
  std::vector<ArmJoint> joints;
  Pose last_from_sensor = Pose::Identity();
  std::vector<ArmBody> bodies;
  std::vector<std::pair<int, int>> joined;  // pairs of bodies that may touch: a joint connects them
};

/// Reads the extent of a mesh that a URDF names, in the mesh's own frame and unit.
using MeshExtent = std::function<Box3(const std::string& file)>;

/// The chain from the root link of a URDF to the link `sensor`, whose axes are the sensor's: x right, y down, z
/// forward. Solids are the collision geometries; of a mesh the box around it is taken, which is never too small. Joints
/// may be fixed, revolute, continuous (limits of one turn to either side) or prismatic. Throws InputError with `name`,
/// the link or joint, and what would be right.
[[nodiscard]] ArmDescription arm_from_urdf(std::string_view urdf, const std::string& name, const std::string& sensor,
                                           const MeshExtent& mesh_extent);

}  // namespace vantage
