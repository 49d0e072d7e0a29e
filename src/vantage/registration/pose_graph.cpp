#include "vantage/registration/pose_graph.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr double sharpening = 4;  // the kernel's squared width shrinks by this with every iteration

double squared_distance(const Vec6& step, const Mat6& information) {
  return std::max(0.0, step.dot(information * step));
}

/// The pose that stands for all that are tied to each other.
std::size_t root(std::vector<std::size_t>& parents, std::size_t pose) {
  while (parents[pose] != pose) pose = parents[pose] = parents[parents[pose]];
  return pose;
}

/// A symmetric matrix of 6x6 blocks with its right side, gathered block by block.
class NormalSystem {
 public:
  explicit NormalSystem(std::size_t poses) : size_(6 * static_cast<Eigen::Index>(poses)), right_(size_) {
    right_.setZero();
  }

  void add(std::size_t row, std::size_t column, const Mat6& block) {
    for (Eigen::Index i = 0; i < 6; ++i) {
      for (Eigen::Index k = 0; k < 6; ++k) {
        entries_.emplace_back(6 * static_cast<Eigen::Index>(row) + i, 6 * static_cast<Eigen::Index>(column) + k,
                              block(i, k));
      }
    }
  }
  void add(std::size_t row, const Vec6& right) { right_.segment<6>(6 * static_cast<Eigen::Index>(row)) += right; }

  [[nodiscard]] Eigen::VectorXd solution() const {
    Eigen::SparseMatrix<double> matrix(size_, size_);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
    if (factors.info() != Eigen::Success || !(factors.vectorD().array() > 0).all())
      throw Error("pose graph: priors and constraints together leave a pose open");
    return factors.solve(right_);
  }

 private:
  Eigen::Index size_;
  Eigen::VectorXd right_;
  std::vector<Eigen::Triplet<double>> entries_;
};

/// The constraint's information in the axes of the world.
Mat6 information_in_world(const PoseConstraint& constraint, std::span<const Pose> poses) {
  Mat6 turn = Mat6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = poses[constraint.from].linear();
  return turn * constraint.information * turn.transpose();
}

/// How the pose that `from` claims for `to` follows a step of `from`: it turns about the position of `from`.
Mat6 effect_of_from(const PoseConstraint& constraint, std::span<const Pose> poses) {
  return effect_at(poses[constraint.from].linear() * constraint.from_of_to.translation());
}

/// One Gauss-Newton step for all poses: a residual changes by the step of `to` less what the step of `from` does there.
Eigen::VectorXd step_of_all(const PoseGraph& graph, std::span<const Pose> poses, std::span<const double> weights) {
  NormalSystem system(poses.size());
  for (const PosePrior& prior : graph.priors) {
    system.add(prior.pose, prior.pose, prior.information);
    system.add(prior.pose, Vec6(-prior.information * pose_step(prior.world_from_sensor, poses[prior.pose])));
  }
  for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
    const PoseConstraint& constraint = graph.constraints[i];
    const Mat6 information = weights[i] * information_in_world(constraint, poses);
    const Vec6 pull = information * residual(constraint, poses);
    const Mat6 effect = effect_of_from(constraint, poses);
    const Mat6 mixed = information * effect;
    system.add(constraint.from, constraint.from, effect.transpose() * mixed);
    system.add(constraint.to, constraint.to, information);
    system.add(constraint.from, constraint.to, -mixed.transpose());
    system.add(constraint.to, constraint.from, -mixed);
    system.add(constraint.from, Vec6(effect.transpose() * pull));
    system.add(constraint.to, Vec6(-pull));
  }
  return system.solution();
}

std::vector<double> squared_distances(const PoseGraph& graph, std::span<const Pose> poses) {
  std::vector<double> distances;
  distances.reserve(graph.constraints.size());
  for (const PoseConstraint& constraint : graph.constraints) {
    distances.push_back(squared_distance(residual(constraint, poses), information_in_world(constraint, poses)));
  }
  return distances;
}

void require_information(const Mat6& information, const std::string& what) {
  require(information.allFinite() && information.isApprox(information.transpose(), 1e-6) &&
              (information.diagonal().array() >= 0).all(),
          what, ": its information must be finite, symmetric and not negative");
}

}  // namespace

Vec6 residual(const PoseConstraint& constraint, std::span<const Pose> poses) {
  return pose_step(poses[constraint.from] * constraint.from_of_to, poses[constraint.to]);
}

void PoseGraph::validate() const {
  std::vector<std::size_t> parents(poses.size());
  std::iota(parents.begin(), parents.end(), std::size_t{0});
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const PoseConstraint& each = constraints[i];
    require(each.from < poses.size() && each.to < poses.size() && each.from != each.to, "pose graph: constraint ", i,
            " ties pose ", each.from, " to ", each.to, "; must be two of the ", poses.size());
    require(each.from_of_to.matrix().allFinite(), "pose graph: constraint ", i, ": its pose is not finite");
    require_information(each.information, concat("pose graph: constraint ", i));
    parents[root(parents, each.to)] = root(parents, each.from);
  }
  std::vector<char> is_reached(poses.size());
  for (std::size_t i = 0; i < priors.size(); ++i) {
    require(priors[i].pose < poses.size(), "pose graph: prior ", i, " is of pose ", priors[i].pose, "; there are ",
            poses.size());
    require(priors[i].world_from_sensor.matrix().allFinite(), "pose graph: prior ", i, ": its pose is not finite");
    require_information(priors[i].information, concat("pose graph: prior ", i));
    is_reached[root(parents, priors[i].pose)] = 1;
  }
  for (std::size_t pose = 0; pose < poses.size(); ++pose) {
    require(poses[pose].matrix().allFinite(), "pose graph: pose ", pose, " is not finite");
    require(is_reached[root(parents, pose)] == 1, "pose graph: pose ", pose,
            ": no prior says where it is, nor where any pose is that it is tied to");
  }
}

void PoseGraphOptions::validate() const {
  require(max_iterations >= 1, "pose graph: max_iterations = ", max_iterations, ": must be at least 1");
  require(tolerance > 0, "pose graph: tolerance = ", tolerance, " m: must be positive");
  require(outlier_distance > 0, "pose graph: outlier_distance = ", outlier_distance, ": must be positive");
}

SolvedPoses solve(const PoseGraph& graph, const PoseGraphOptions& options) {
  graph.validate();
  options.validate();
  SolvedPoses solved{graph.poses, std::vector<double>(graph.constraints.size(), 1.0), 0, graph.poses.empty()};
  double width = 0;  // of the kernel, squared; it begins where the worst constraint of least squares counts half
  while (!solved.converged && solved.iterations < options.max_iterations) {
    ++solved.iterations;
    const Eigen::VectorXd steps = step_of_all(graph, solved.poses, solved.weights);
    for (std::size_t i = 0; i < solved.poses.size(); ++i) {
      solved.poses[i] = stepped(solved.poses[i], steps.segment<6>(6 * static_cast<Eigen::Index>(i)));
    }
    const std::vector<double> distances = squared_distances(graph, solved.poses);
    if (solved.iterations == 1 && !distances.empty()) width = *std::max_element(distances.begin(), distances.end());
    const bool is_sharp = width <= options.outlier_distance;
    width = std::max(options.outlier_distance, width / sharpening);
    std::transform(distances.begin(), distances.end(), solved.weights.begin(),
                   [width](double distance) { return 1 / (1 + distance / width); });
    solved.converged = is_sharp && steps.lpNorm<Eigen::Infinity>() < options.tolerance;
  }
  return solved;
}

}  // namespace vantage
