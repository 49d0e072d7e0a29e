#include "vantage/arm/arm.hpp"

#include <algorithm>

#include "vantage/arm/arm_collision.hpp"
#include "vantage/arm/joint_path.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// A path that is this much longer than the least cost is worth a search for a shorter one.
constexpr double long_detour = 1.5;

class ArmMobility : public Mobility {
 public:
  ArmMobility(const Arm& arm, const Surroundings& surroundings)
      : arm_(arm), collision_(arm.kinematics(), arm.options().padding, surroundings) {
    const ArmDescription& description = arm.kinematics().arm();
    space_.lower.resize(arm.kinematics().joints());
    space_.upper.resize(arm.kinematics().joints());
    for (Eigen::Index j = 0; j < arm.kinematics().joints(); ++j) {
      space_.lower[j] = description.joints[static_cast<std::size_t>(j)].lower;
      space_.upper[j] = description.joints[static_cast<std::size_t>(j)].upper;
    }
    space_.weights = arm.options().weights;
    space_.most_nodes = arm.options().most_nodes;
    space_.is_clear = [this](const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return collision_.is_clear(a, b); };
  }

  [[nodiscard]] std::optional<std::string> why_unreachable(const View& view) const override {
    const auto remembered = arm_.inverse(view);
    const std::vector<Eigen::VectorXd>& solutions = *remembered;
    if (solutions.empty()) return "no joints within their limits bring the sensor there";
    std::optional<std::string> reason;
    for (const Eigen::VectorXd& joints : solutions) {
      auto touching = collision_.why_touching(joints);
      if (!touching) return std::nullopt;
      if (!reason) reason = std::move(touching);
    }
    if (solutions.size() == 1) return reason;
    return concat("for all ", solutions.size(), " joint positions there the arm touches something: ", *reason);
  }

  [[nodiscard]] double least_cost(const RobotState& from, const View& to) const override {
    const std::vector<Eigen::VectorXd> goals = goals_by_distance(from.joints, to);
    return goals.empty() ? 0 : space_.distance(from.joints, goals.front());
  }

  [[nodiscard]] Move move(const RobotState& from, const View& to) const override {
    Move move;
    const std::vector<Eigen::VectorXd> goals = goals_by_distance(from.joints, to);
    if (goals.empty()) {
      move.why_not = why_unreachable(to).value_or("");
      return move;
    }
    if (const auto touching = collision_.why_touching(from.joints)) {
      move.why_not = concat("the arm cannot leave where it is: ", *touching);
      return move;
    }
    JointPath path = straight(from.joints, goals);
    const double least = space_.distance(from.joints, goals.front());
    if (path.empty() || space_.length(path) > long_detour * least) {
      Random random(arm_.options().seed);
      auto found = connect(space_, from.joints, goals, random);
      if (found && (path.empty() || space_.length(*found) < space_.length(path))) path = *std::move(found);
    }
    if (path.empty()) {
      move.why_not = concat("no path of the joints was found among ", space_.most_nodes, " places");
      return move;
    }
    move.cost = space_.length(path);
    for (const Eigen::VectorXd& joints : path) {
      move.path.push_back({View{arm_.kinematics().world_from_sensor(joints)}, joints});
    }
    move.path.front().view = from.view;
    move.path.back().view = to;
    return move;
  }

 private:
  /// The joints that hold the sensor at a view without touching anything, the nearest first.
  [[nodiscard]] std::vector<Eigen::VectorXd> goals_by_distance(const Eigen::VectorXd& from, const View& to) const {
    std::vector<Eigen::VectorXd> goals;
    const auto solutions = arm_.inverse(to);
    for (const Eigen::VectorXd& joints : *solutions) {
      if (!collision_.why_touching(joints)) goals.push_back(arm_.kinematics().nearest_turns(joints, from));
    }
    std::stable_sort(goals.begin(), goals.end(), [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      return space_.distance(from, a) < space_.distance(from, b);
    });
    return goals;
  }

  /// The straight move to the nearest goal that has a clear one.
  [[nodiscard]] JointPath straight(const Eigen::VectorXd& from, const std::vector<Eigen::VectorXd>& goals) const {
    for (const Eigen::VectorXd& goal : goals) {
      if (collision_.is_clear(from, goal)) return {from, goal};
    }
    return {};
  }

  const Arm& arm_;
  ArmCollision collision_;
  JointSpace space_;
};

/// The arm whose links of these names may touch each other.
ArmDescription allowing(ArmDescription arm, const std::vector<std::pair<std::string, std::string>>& may_touch) {
  const auto body = [&](const std::string& link) {
    const auto found =
        std::find_if(arm.bodies.begin(), arm.bodies.end(), [&](const ArmBody& each) { return each.link == link; });
    std::string links;
    for (const ArmBody& each : arm.bodies) links += (links.empty() ? "" : ", ") + each.link;
    require(found != arm.bodies.end(), "may-touch: there is no link '", link,
            "' with a solid; these have one: ", links);
    return static_cast<int>(found - arm.bodies.begin());
  };
  for (const auto& [first, second] : may_touch) {
    const int a = body(first), b = body(second);
    require(a != b, "may-touch: '", first, "' stands beside itself; must be two links");
    arm.joined.emplace_back(std::min(a, b), std::max(a, b));
  }
  return arm;
}

ArmOptions completed(ArmOptions options, std::size_t joints) {
  const auto count = static_cast<Eigen::Index>(joints);
  if (options.home.size() == 0) options.home = Eigen::VectorXd::Zero(count);
  if (options.weights.size() == 0) options.weights = Eigen::VectorXd::Ones(count);
  options.validate(joints);
  return options;
}

}  // namespace

void ArmOptions::validate(std::size_t joints) const {
  const auto count = static_cast<Eigen::Index>(joints);
  require(home.size() == count, "home has ", home.size(), " values; the arm has ", joints, " joints");
  require(weights.size() == count, "joint-weights has ", weights.size(), " values; the arm has ", joints, " joints");
  require(home.allFinite(), "home: must be finite");
  require(weights.allFinite() && (weights.array() > 0).all(), "joint-weights: must be positive");
  require(padding > 0 && std::isfinite(padding), "padding = ", padding, " m: must be positive");
  require(most_remembered >= 2, "most_remembered = ", most_remembered, ": must be at least 2");
  require(most_nodes > 1, "path-nodes = ", most_nodes, ": must be at least 2");
}

Arm::Arm(ArmDescription arm, const ArmOptions& options)
    : kinematics_(allowing(std::move(arm), options.may_touch), options.world_from_base),
      options_(completed(options, static_cast<std::size_t>(kinematics_.joints()))) {
  for (Eigen::Index j = 0; j < kinematics_.joints(); ++j) {
    const ArmJoint& joint = kinematics_.arm().joints[static_cast<std::size_t>(j)];
    require(options_.home[j] >= joint.lower && options_.home[j] <= joint.upper, "home: joint ", joint.name, " at ",
            options_.home[j], " is beyond its limits ", joint.lower, " .. ", joint.upper);
  }
  const auto touching = ArmCollision(kinematics_, options_.padding).why_touching(options_.home);
  require(!touching, "home: ", touching.value_or(""), " (solids are grown by ", options_.padding,
          " m); two links that may touch are named by may-touch: LINK LINK");
}

std::unique_ptr<Mobility> Arm::among(const Surroundings& surroundings) const {
  return std::make_unique<ArmMobility>(*this, surroundings);
}

std::optional<RobotState> Arm::home() const {
  return RobotState{View{kinematics_.world_from_sensor(options_.home)}, options_.home};
}

std::optional<RobotState> Arm::state_at(const View& view) const {
  const ArmCollision collision(kinematics_, options_.padding);
  std::optional<RobotState> nearest;
  double least = 0;
  const auto solutions = inverse(view);
  for (const Eigen::VectorXd& solution : *solutions) {
    const Eigen::VectorXd joints = kinematics_.nearest_turns(solution, options_.home);
    const double distance = (joints - options_.home).cwiseProduct(options_.weights).norm();
    if ((nearest && distance >= least) || collision.why_touching(joints)) continue;
    nearest = RobotState{view, joints};
    least = distance;
  }
  return nearest;
}

std::shared_ptr<const std::vector<Eigen::VectorXd>> Arm::inverse(const View& view) const {
  std::array<double, 12> key{};
  Eigen::Map<Eigen::Matrix<double, 3, 4>>(key.data()) = view.world_from_sensor.matrix().topRows<3>();
  {
    const std::lock_guard lock(remembering_);
    if (const auto found = recent_.find(key); found != recent_.end()) return found->second;
    if (const auto found = older_.find(key); found != older_.end()) {
      auto joints = found->second;
      remember(key, joints);
      return joints;
    }
  }
  auto joints = std::make_shared<const std::vector<Eigen::VectorXd>>(kinematics_.inverse(view.world_from_sensor));
  const std::lock_guard lock(remembering_);
  remember(key, joints);
  return joints;
}

void Arm::remember(const std::array<double, 12>& key,
                   std::shared_ptr<const std::vector<Eigen::VectorXd>> joints) const {
  if (recent_.size() >= options_.most_remembered / 2) older_ = std::exchange(recent_, {});
  recent_.try_emplace(key, std::move(joints));
}

std::size_t Arm::remembered() const {
  const std::lock_guard lock(remembering_);
  return recent_.size() + older_.size();
}

}  // namespace vantage
