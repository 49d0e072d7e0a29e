#include "vantage/registration/normal_equations.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr std::size_t block_size = 256;

NormalEquations sums(std::span<const PlanePair> pairs, const MotionFrame& frame) {
  NormalEquations sum;
  for (const PlanePair& pair : pairs) {
    const Vec6 row = effect_along(pair.normal, pair.point, frame);
    const Vec6 scan_row = effect_along(pair.scan_normal, pair.point, frame);
    sum.matrix += pair.weight * row * row.transpose();
    sum.right_side += pair.weight * pair.residual() * row;
    sum.resistance += pair.weight / 2 * (row * scan_row.transpose() + scan_row * row.transpose());
    sum.weight += pair.weight;
  }
  return sum;
}

}  // namespace

Vec6 effect_along(const Vec3& normal, const Vec3& point, const MotionFrame& frame) {
  Vec6 effect;
  effect << normal, (point - frame.center).cross(normal) / frame.length;
  return effect;
}

Pose MotionFrame::motion(const Vec6& step) const {
  const Vec3 rotation_vector = step.tail<3>() / length;
  const double angle = rotation_vector.norm();
  Pose motion = Pose::Identity();
  if (angle > 0) motion.linear() = Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
  motion.translation() = center - motion.linear() * center + step.head<3>();
  return motion;
}

Vec6 MotionFrame::step(const Pose& from, const Pose& to) const {
  const Pose motion = to * from.inverse();
  const Eigen::AngleAxisd rotation(Mat3(motion.linear()));
  Vec6 step;
  step << motion * center - center, length * rotation.angle() * rotation.axis();
  return step;
}

NormalEquations normal_equations(std::span<const PlanePair> pairs, const MotionFrame& frame) {
  std::vector<NormalEquations> blocks((pairs.size() + block_size - 1) / block_size);
  parallel_for(blocks.size(), [&](std::size_t i) {
    blocks[i] = sums(pairs.subspan(i * block_size, std::min(block_size, pairs.size() - i * block_size)), frame);
  });
  NormalEquations total;
  for (const NormalEquations& block : blocks) {
    total.matrix += block.matrix;
    total.right_side += block.right_side;
    total.resistance += block.resistance;
    total.weight += block.weight;
  }
  if (total.weight > 0) {
    total.matrix /= total.weight;
    total.right_side /= total.weight;
    total.resistance /= total.weight;
  }
  return total;
}

Directions directions(const NormalEquations& equations, double least_resistance) {
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(equations.matrix);
  Directions result;
  result.vectors = solver.eigenvectors();
  for (int k = 0; k < 6; ++k) {
    const Vec6 direction = result.vectors.col(k);
    const double resistance = std::min(solver.eigenvalues()[k], direction.dot(equations.resistance * direction));
    result.is_open[static_cast<std::size_t>(k)] = !(resistance >= least_resistance);
  }
  return result;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> Directions::columns(bool wanted) const {
  Eigen::Matrix<double, 6, Eigen::Dynamic> found(6, std::count(is_open.begin(), is_open.end(), wanted));
  Eigen::Index next = 0;
  for (int k = 0; k < 6; ++k) {
    if (is_open[static_cast<std::size_t>(k)] == wanted) found.col(next++) = vectors.col(k);
  }
  return found;
}

Vec6 rotation_averse_cost() {
  constexpr double rotation_cost = 100;  // turning a sphere about its centre must not pass for a shift of the scan
  Vec6 cost;
  cost << Vec3::Ones(), Vec3::Constant(rotation_cost * rotation_cost);
  return cost;
}

Vec6 solve(const NormalEquations& equations, const Directions& directions, const Vec6& from_believed,
           const Vec6& cost) {
  Vec6 step = Vec6::Zero();
  const Eigen::Matrix<double, 6, Eigen::Dynamic> determined = directions.determined();
  if (determined.cols() > 0) {
    const Eigen::MatrixXd matrix = determined.transpose() * equations.matrix * determined;
    const Eigen::VectorXd side = determined.transpose() * equations.right_side;
    step = determined * matrix.ldlt().solve(side);
  }
  const Eigen::Matrix<double, 6, Eigen::Dynamic> open = directions.open();
  if (open.cols() > 0) {
    const Eigen::MatrixXd normal = open.transpose() * cost.asDiagonal() * open;
    const Eigen::VectorXd side = -(open.transpose() * cost.asDiagonal() * (from_believed + step));
    step += open * normal.ldlt().solve(side);
  }
  return step;
}

}  // namespace vantage
