#include "vantage/arm/arm_collision.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/robot/solid_boxes.hpp"

namespace vantage {
namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

Geometry grown(const LinkShape& shape, double padding) {
  switch (shape.kind) {
    case LinkShape::Kind::cylinder:
      return std::make_shared<fcl::Cylinderd>(shape.size.x() + padding, shape.size.y() + 2 * padding);
    case LinkShape::Kind::sphere:
      return std::make_shared<fcl::Sphered>(shape.size.x() + padding);
    case LinkShape::Kind::box:
      break;
  }
  const Vec3 size = shape.size.array() + 2 * padding;
  return std::make_shared<fcl::Boxd>(size);
}

struct Solid {
  std::size_t body;
  Pose joint_from_solid;
  Geometry geometry;
};

bool touch(const fcl::CollisionObjectd& a, const fcl::CollisionObjectd& b) {
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return fcl::collide(&a, &b, request, result) > 0;
}

/// The first object of the surroundings that a solid touches.
const fcl::CollisionObjectd* touched(const fcl::DynamicAABBTreeCollisionManagerd& surroundings,
                                     fcl::CollisionObjectd& solid) {
  struct Found {
    const fcl::CollisionObjectd* solid;
    const fcl::CollisionObjectd* other = nullptr;
  } found{&solid};
  surroundings.collide(&solid, &found, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    auto* target = static_cast<Found*>(data);
    if (!touch(*a, *b)) return false;
    target->other = a == target->solid ? b : a;
    return true;  // no need to look further
  });
  return found.other;
}

}  // namespace

struct ArmCollision::Solids {
  std::vector<Solid> moving, fixed;                        // of the arm
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  // of bodies that must not touch each other
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> around;
  fcl::DynamicAABBTreeCollisionManagerd surroundings;
};

ArmCollision::ArmCollision(const ArmKinematics& arm, double padding)
    : arm_(arm), padding_(padding), solids_(std::make_unique<Solids>()) {
  const std::vector<ArmBody>& bodies = arm.arm().bodies;
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (const LinkShape& shape : bodies[a].shapes) {
      (bodies[a].joint < 0 ? solids_->fixed : solids_->moving)
          .push_back({a, shape.joint_from_shape, grown(shape, padding)});
    }
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      const std::pair<int, int> pair(static_cast<int>(a), static_cast<int>(b));
      const auto& joined = arm.arm().joined;
      if (bodies[a].joint == bodies[b].joint || std::find(joined.begin(), joined.end(), pair) != joined.end()) continue;
      solids_->pairs.emplace_back(a, b);
    }
  }
}

ArmCollision::ArmCollision(const ArmKinematics& arm, double padding, const Surroundings& surroundings)
    : ArmCollision(arm, padding) {
  std::vector<Box3> boxes = solid_boxes(surroundings.map);
  boxes.insert(boxes.end(), surroundings.obstacles.begin(), surroundings.obstacles.end());
  std::vector<fcl::CollisionObjectd*> objects;
  for (const Box3& box : boxes) {
    solids_->around.push_back(std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(Vec3(box.sizes())),
                                                                      Mat3::Identity(), Vec3(box.center())));
    objects.push_back(solids_->around.back().get());
  }
  solids_->surroundings.registerObjects(objects);
  solids_->surroundings.setup();
}

ArmCollision::~ArmCollision() = default;

std::optional<std::string> ArmCollision::why_touching(const Eigen::VectorXd& joints) const {
  const std::vector<Pose> frames = arm_.world_from_joints(joints);
  const std::vector<ArmBody>& bodies = arm_.arm().bodies;
  std::vector<std::vector<fcl::CollisionObjectd>> objects(bodies.size());
  for (const Solid& solid : solids_->fixed) {
    objects[solid.body].emplace_back(solid.geometry, arm_.world_from_base() * solid.joint_from_solid);
  }
  for (const Solid& solid : solids_->moving) {
    const Pose& frame = frames[static_cast<std::size_t>(bodies[solid.body].joint)];
    objects[solid.body].emplace_back(solid.geometry, frame * solid.joint_from_solid);
  }
  for (const auto& [a, b] : solids_->pairs) {
    for (const fcl::CollisionObjectd& first : objects[a]) {
      for (const fcl::CollisionObjectd& second : objects[b]) {
        if (first.getAABB().overlap(second.getAABB()) && touch(first, second)) {
          return concat("link ", bodies[a].link, " touches link ", bodies[b].link);
        }
      }
    }
  }
  if (solids_->surroundings.empty()) return std::nullopt;
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    if (bodies[body].joint < 0) continue;
    for (fcl::CollisionObjectd& object : objects[body]) {
      if (const fcl::CollisionObjectd* other = touched(solids_->surroundings, object)) {
        const Vec3 near = other->getTranslation();
        return concat("link ", bodies[body].link, " touches what is not known to be free around (",
                      std::round(1000 * near.x()) / 1000, ", ", std::round(1000 * near.y()) / 1000, ", ",
                      std::round(1000 * near.z()) / 1000, ")");
      }
    }
  }
  return std::nullopt;
}

bool ArmCollision::is_clear(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  if (why_touching(from) || why_touching(to)) return false;
  // Between two places that are asked, a point is nearest to one of them by at most half of the way between them, which
  // the padding covers.
  const double farthest = (to - from).cwiseAbs().dot(arm_.reach_of_joints());
  const auto pieces = static_cast<int>(std::ceil(farthest / (2 * padding_)));
  // Halving asks the places in the middle first: what is in the way is found early.
  int stride = 1;
  while (stride < pieces) stride *= 2;
  for (; stride >= 2; stride /= 2) {
    for (int at = stride / 2; at < pieces; at += stride) {
      if (why_touching(from + (to - from) * (static_cast<double>(at) / pieces))) return false;
    }
  }
  return true;
}

}  // namespace vantage
