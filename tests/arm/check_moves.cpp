// check_moves URDF SENSOR_LINK SCENE.off MOVES.txt VIEWS: walks through every move in small steps and asks FCL whether
// a link touches the true scene or another link. Shares no code with the library: the URDF's tree is walked here.
//
// Each line of MOVES is one corner of a path: number of the view, x y z and axis (3) of the view that the move leads
// to, then the joints.

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Pose = Eigen::Isometry3d;
using Vec3 = Eigen::Vector3d;
using Joints = std::vector<double>;

constexpr double largest_step = 0.005;  // radians of any joint between two places

Pose pose_of(const urdf::Pose& p) {
  Pose pose = Pose::Identity();
  pose.translate(Vec3(p.position.x, p.position.y, p.position.z));
  pose.rotate(Eigen::Quaterniond(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z));
  return pose;
}

struct Part {
  std::string link;
  Pose link_from_part;
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
};

std::shared_ptr<fcl::CollisionGeometryd> geometry_of(const urdf::Geometry& geometry) {
  if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry)) {
    return std::make_shared<fcl::Boxd>(box->dim.x, box->dim.y, box->dim.z);
  }
  const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
  return std::make_shared<fcl::Cylinderd>(cylinder.radius, cylinder.length);
}

using Mesh = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Mesh> mesh_from_off(const std::string& path) {
  std::ifstream file(path);
  std::string word;
  std::size_t vertices = 0, triangles = 0, edges = 0;
  file >> word >> vertices >> triangles >> edges;
  std::vector<Vec3> points(vertices);
  for (Vec3& point : points) file >> point.x() >> point.y() >> point.z();
  std::vector<fcl::Triangle> corners;
  for (std::size_t i = 0; i < triangles; ++i) {
    std::size_t count = 0, a = 0, b = 0, c = 0;
    file >> count >> a >> b >> c;
    corners.emplace_back(a, b, c);
  }
  if (!file || corners.empty()) std::fprintf(stderr, "%s cannot be read\n", path.c_str());
  auto mesh = std::make_shared<Mesh>();
  mesh->beginModel();
  mesh->addSubModel(points, corners);
  mesh->endModel();
  return mesh;
}

class Checker {
 public:
  Checker(const urdf::ModelInterface& model, const std::string& sensor, const std::string& scene)
      : model_(model), scene_(mesh_from_off(scene)) {
    for (auto link = model.getLink(sensor); link->getParent() != nullptr; link = link->getParent()) {
      if (link->parent_joint->type != urdf::Joint::FIXED) joints_.insert(joints_.begin(), link->parent_joint);
    }
    for (const auto& [name, link] : model.links_) {
      for (const auto& solid : link->collision_array) {
        parts_.push_back({name, pose_of(solid->origin), geometry_of(*solid->geometry)});
      }
    }
  }

  [[nodiscard]] std::size_t joints() const { return joints_.size(); }
  [[nodiscard]] bool within_limits(const Joints& joints) const {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (joints[j] < joints_[j]->limits->lower || joints[j] > joints_[j]->limits->upper) return false;
    }
    return true;
  }
  [[nodiscard]] Joints random_joints(std::mt19937& random) const {
    Joints joints;
    for (const auto& joint : joints_) {
      joints.push_back(std::uniform_real_distribution<>(joint->limits->lower, joint->limits->upper)(random));
    }
    return joints;
  }
  [[nodiscard]] Pose world_from(const std::string& link_name, const Joints& joints) const {
    const auto link = model_.getLink(link_name);
    const auto joint = link->parent_joint;
    if (joint == nullptr) return Pose::Identity();
    Pose pose = world_from(joint->parent_link_name, joints) * pose_of(joint->parent_to_joint_origin_transform);
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (joints_[j]->name != joint->name) continue;
      pose.rotate(Eigen::AngleAxisd(joints[j], Vec3(joint->axis.x, joint->axis.y, joint->axis.z).normalized()));
    }
    return pose;
  }
  /// What touches, empty where nothing does.
  [[nodiscard]] std::string touching(const Joints& joints) const {
    std::map<std::string, Pose> poses;
    for (const Part& part : parts_) poses[part.link] = world_from(part.link, joints);
    for (const Part& part : parts_) {
      const Pose place = poses[part.link] * part.link_from_part;
      if (part.link != model_.getRoot()->name && touch(*part.geometry, place, *scene_, Pose::Identity())) {
        return part.link + " touches the scene";
      }
      for (const Part& other : parts_) {
        if (other.link <= part.link || are_joined(part.link, other.link)) continue;
        if (touch(*part.geometry, place, *other.geometry, poses[other.link] * other.link_from_part)) {
          return part.link + " touches " + other.link;
        }
      }
    }
    return {};
  }

 private:
  [[nodiscard]] static bool touch(const fcl::CollisionGeometryd& a, const Pose& at_a, const fcl::CollisionGeometryd& b,
                                  const Pose& at_b) {
    const fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    return fcl::collide(&a, at_a, &b, at_b, request, result) > 0;
  }
  [[nodiscard]] bool are_joined(const std::string& a, const std::string& b) const {
    const auto is_child = [this](const std::string& child, const std::string& parent) {
      const auto joint = model_.getLink(child)->parent_joint;
      return joint != nullptr && joint->parent_link_name == parent;
    };
    return is_child(a, b) || is_child(b, a);
  }

  const urdf::ModelInterface& model_;
  std::shared_ptr<Mesh> scene_;
  std::vector<urdf::JointSharedPtr> joints_;
  std::vector<Part> parts_;
};

struct Corner {
  int view = -1;
  Vec3 position, axis;
  Joints joints;
};

std::vector<Corner> corners_from(const std::string& path, std::size_t joints) {
  std::vector<Corner> corners;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    Corner corner;
    corner.joints.resize(joints);
    words >> corner.view;
    for (int i = 0; i < 3; ++i) words >> corner.position[i];
    for (int i = 0; i < 3; ++i) words >> corner.axis[i];
    for (double& joint : corner.joints) words >> joint;
    if (words) corners.push_back(corner);
  }
  return corners;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const auto model = urdf::parseURDFFile(argv[1]);
  const Checker checker(*model, argv[2], argv[3]);
  const std::vector<Corner> corners = corners_from(argv[4], checker.joints());

  // A checker that never finds a touch would be content with anything.
  std::mt19937 random(1);
  int random_touches = 0;
  for (int i = 0; i < 200; ++i) random_touches += checker.touching(checker.random_joints(random)).empty() ? 0 : 1;

  int failures = 0;
  long places = 0;
  std::set<int> reached;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Corner& corner = corners[i];
    const bool is_last = i + 1 == corners.size() || corners[i + 1].view != corner.view;
    if (is_last) {
      const Pose sensor = checker.world_from(argv[2], corner.joints);
      const bool is_there = (sensor.translation() - corner.position).norm() < 1e-5 &&
                            (sensor.linear().col(2) - corner.axis).norm() < 1e-5;
      if (is_there) reached.insert(corner.view);
      failures += is_there ? 0 : 1;
    }
    if (i == 0) continue;
    const Joints& from = corners[i - 1].joints;
    double farthest = 0;
    for (std::size_t j = 0; j < from.size(); ++j) farthest = std::max(farthest, std::abs(corner.joints[j] - from[j]));
    const bool continues = corners[i - 1].view == corner.view;
    if (!continues && farthest > 1e-9) {
      std::printf("view %d does not begin where the move before it ends\n", corner.view);
      ++failures;
    }
    const int steps = std::max(1, static_cast<int>(std::ceil(farthest / largest_step)));
    for (int step = 0; step <= steps; ++step, ++places) {
      Joints joints = from;
      for (std::size_t j = 0; j < from.size(); ++j) joints[j] += (corner.joints[j] - from[j]) * step / steps;
      const std::string what = checker.within_limits(joints) ? checker.touching(joints) : "a joint beyond its limits";
      if (what.empty()) continue;
      if (failures++ < 10) std::printf("view %d: %s\n", corner.view, what.c_str());
    }
  }
  std::printf(
      "%zu views reached, %ld places of the arm checked with FCL, %d failures (%d of 200 random places touch)\n",
      reached.size(), places, failures, random_touches);
  return failures == 0 && static_cast<int>(reached.size()) == std::stoi(argv[5]) && random_touches > 20 ? 0 : 1;
}
