#include "vantage/arm/arm_description.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include "vantage/arm/urdf_check.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// What the URDF parser says while it reads; it would go to the terminal otherwise.
class ParserMessages : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  [[nodiscard]] const std::string& first() const { return first_; }

 private:
  std::string first_;
};

urdf::ModelInterfaceSharedPtr parsed(std::string_view text, const std::string& name) {
  static std::mutex one_at_a_time;  // the parser has one place for its messages in the whole process
  const std::lock_guard lock(one_at_a_time);
  ParserMessages messages;
  console_bridge::useOutputHandler(&messages);
  urdf::ModelInterfaceSharedPtr model;
  std::string thrown;
  try {
    model = urdf::parseURDF(std::string(text));
  } catch (const std::exception& error) {
    thrown = error.what();
  }
  console_bridge::restorePreviousOutputHandler();
  if (!thrown.empty()) throw InputError(concat(name, ": not a robot description (URDF): ", thrown));
  require(model != nullptr, name,
          ": not a robot description (URDF): ", messages.first().empty() ? "it cannot be parsed" : messages.first());
  return model;
}

Pose pose_of(const urdf::Pose& pose, const std::string& place) {
  const Eigen::Quaterniond rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  Pose result = Pose::Identity();
  result.linear() = rotation.normalized().toRotationMatrix();
  result.translation() = Vec3(pose.position.x, pose.position.y, pose.position.z);
  require(result.matrix().allFinite(), place, ": its origin has a number that is not finite");
  return result;
}

Box3 extent_of(const std::string& mesh, const std::string& place, const MeshExtent& mesh_extent) {
  try {
    return mesh_extent(mesh);
  } catch (const InputError& error) {
    throw InputError(concat(place, ": ", error.what()));
  }
}

LinkShape shape_of(const urdf::Collision& collision, const std::string& place, const MeshExtent& mesh_extent) {
  require(collision.geometry != nullptr, place, ": a collision element without geometry");
  LinkShape shape;
  shape.joint_from_shape = pose_of(collision.origin, place);
  switch (collision.geometry->type) {
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = static_cast<const urdf::Box&>(*collision.geometry).dim;
      shape.size = Vec3(size.x, size.y, size.z);
      break;
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(*collision.geometry);
      shape.kind = LinkShape::Kind::cylinder;
      shape.size = Vec3(cylinder.radius, cylinder.length, 1);
      break;
    }
    case urdf::Geometry::SPHERE:
      shape.kind = LinkShape::Kind::sphere;
      shape.size = Vec3(static_cast<const urdf::Sphere&>(*collision.geometry).radius, 1, 1);
      break;
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(*collision.geometry);
      const Box3 extent = extent_of(mesh.filename, place, mesh_extent);
      const Vec3 scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
      shape.size = extent.sizes().cwiseProduct(scale.cwiseAbs());
      shape.joint_from_shape = shape.joint_from_shape * Eigen::Translation3d(extent.center().cwiseProduct(scale));
      break;
    }
  }
  require((shape.size.array() > 0).all() && shape.size.allFinite(), place,
          ": its collision geometry has a size that is not positive");
  return shape;
}

class Reader {
 public:
  Reader(const urdf::ModelInterface& model, const std::string& name, const std::string& sensor,
         const MeshExtent& mesh_extent, const std::map<std::string, std::size_t>& solids)
      : model_(model), name_(name), mesh_extent_(mesh_extent), solids_(solids) {
    const urdf::LinkConstSharedPtr goal = model.getLink(sensor);
    require(goal != nullptr, name, ": there is no link '", sensor, "' to carry the sensor; the links are ", links());
    std::set<std::string> leads_to_sensor;
    for (urdf::LinkConstSharedPtr link = goal; link != nullptr; link = link->getParent()) {
      leads_to_sensor.insert(link->name);
    }
    on_the_chain_ = std::move(leads_to_sensor);
    sensor_ = sensor;
    visit(*model.getRoot(), -1, Pose::Identity(), -1);
    require(!arm_.joints.empty(), name, ": no joint between the root link '", model.getRoot()->name, "' and '", sensor,
            "' can move");
  }

  [[nodiscard]] ArmDescription arm() && { return std::move(arm_); }

 private:
  [[nodiscard]] std::string links() const {
    std::string text;
    for (const auto& [link, ignored] : model_.links_) text += (text.empty() ? "" : ", ") + link;
    return text;
  }

  /// A link whose frame is `joint_from_link` in the frame of `joint`, and all that hangs on it.
  void visit(const urdf::Link& link, int joint, const Pose& joint_from_link, int parent_body) {
    const std::string place = concat(name_, ": link '", link.name, "'");
    ArmBody body{link.name, joint, {}};
    const auto solids = solids_.find(link.name);
    require(link.collision_array.size() == (solids == solids_.end() ? 0 : solids->second), place,
            ": the parser of URDF dropped one of its elements <collision>");
    for (std::size_t i = 0; i < link.collision_array.size(); ++i) {
      const std::string element = concat(place, ", collision ", i + 1);
      require(link.collision_array[i] != nullptr, element, ": the parser of URDF dropped it");
      LinkShape shape = shape_of(*link.collision_array[i], element, mesh_extent_);
      shape.joint_from_shape = joint_from_link * shape.joint_from_shape;
      body.shapes.push_back(std::move(shape));
    }
    if (link.name == sensor_) arm_.last_from_sensor = joint_from_link;
    // A frame without a solid hands its neighbours on: what it joins is joined with each other.
    int self = parent_body;
    if (!body.shapes.empty()) {
      self = static_cast<int>(arm_.bodies.size());
      if (parent_body >= 0) arm_.joined.emplace_back(parent_body, self);
      arm_.bodies.push_back(std::move(body));
    }
    for (const urdf::JointSharedPtr& next : link.child_joints) {
      const urdf::LinkConstSharedPtr child = model_.getLink(next->child_link_name);
      const Pose joint_from_next = joint_from_link * pose_of(next->parent_to_joint_origin_transform,
                                                             concat(name_, ": joint '", next->name, "'"));
      const bool moves = next->type != urdf::Joint::FIXED && on_the_chain_.contains(child->name);
      if (moves) {
        arm_.joints.push_back(joint_of(*next, joint_from_next));
        visit(*child, static_cast<int>(arm_.joints.size()) - 1, Pose::Identity(), self);
      } else {
        visit(*child, joint, joint_from_next, self);
      }
    }
  }

  [[nodiscard]] ArmJoint joint_of(const urdf::Joint& joint, const Pose& previous_from_joint) const {
    const std::string place = concat(name_, ": joint '", joint.name, "'");
    const bool turns = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS;
    require(turns || joint.type == urdf::Joint::PRISMATIC, place,
            ": is neither fixed nor revolute, continuous or prismatic");
    require(joint.mimic == nullptr, place, ": mimics another joint, which joints before the sensor may not");
    ArmJoint result;
    result.name = joint.name;
    result.kind = turns ? ArmJoint::Kind::revolute : ArmJoint::Kind::prismatic;
    result.previous_from_joint = previous_from_joint;
    const Vec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
    require(axis.allFinite() && axis.norm() > 1e-9, place, ": its axis has no direction");
    result.axis = axis.normalized();
    result.lower = -2 * std::numbers::pi;
    result.upper = 2 * std::numbers::pi;
    if (joint.type != urdf::Joint::CONTINUOUS) {
      require(joint.limits != nullptr, place, ": has no limits");
      result.lower = joint.limits->lower;
      result.upper = joint.limits->upper;
    }
    require(std::isfinite(result.lower) && std::isfinite(result.upper) && result.lower < result.upper, place,
            ": its limits ", result.lower, " .. ", result.upper, " are not in ascending order");
    return result;
  }

  const urdf::ModelInterface& model_;
  std::string name_, sensor_;
  const MeshExtent& mesh_extent_;
  const std::map<std::string, std::size_t>& solids_;  // that each link must have
  std::set<std::string> on_the_chain_;
  ArmDescription arm_;
};

}  // namespace

ArmDescription arm_from_urdf(std::string_view urdf, const std::string& name, const std::string& sensor,
                             const MeshExtent& mesh_extent) {
  const CheckedUrdf checked = check_urdf(urdf, name);
  const urdf::ModelInterfaceSharedPtr model = parsed(checked.text, name);
  require(model->getRoot() != nullptr, name, ": has no root link");
  return Reader(*model, name, sensor, mesh_extent, checked.solids).arm();
}

}  // namespace vantage
