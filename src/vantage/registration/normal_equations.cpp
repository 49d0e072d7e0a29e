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
    Vec6 row;
    row << pair.normal, (pair.point - frame.center).cross(pair.normal) / frame.length;
    sum.matrix += pair.weight * row * row.transpose();
    sum.right_side += pair.weight * pair.residual() * row;
    sum.weight += pair.weight;
  }
  return sum;
}

}  // namespace

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
    total.weight += block.weight;
  }
  if (total.weight > 0) {
    total.matrix /= total.weight;
    total.right_side /= total.weight;
  }
  return total;
}

double resistance_to_undetermined(const NormalEquations& part, const NormalEquations& whole, double least_eigenvalue) {
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(part.matrix);
  int count = 0;
  while (count < 6 && solver.eigenvalues()[count] < least_eigenvalue) ++count;
  if (count == 0) return 0;
  const Eigen::MatrixXd open = solver.eigenvectors().leftCols(count);
  const Eigen::MatrixXd among_open = open.transpose() * whole.matrix * open;
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(among_open).eigenvalues().maxCoeff();
}

DeterminedStep solve(const NormalEquations& equations, double least_eigenvalue, const Vec6& from_believed) {
  const Eigen::SelfAdjointEigenSolver<Mat6> solver(equations.matrix);  // eigenvalues ascend
  DeterminedStep result;
  for (int k = 0; k < 6; ++k) {
    const double eigenvalue = solver.eigenvalues()[k];
    if (eigenvalue < least_eigenvalue) {
      ++result.undetermined_directions;
      continue;
    }
    const Vec6 direction = solver.eigenvectors().col(k);
    result.step += direction * (direction.dot(equations.right_side) / eigenvalue);
  }
  if (result.undetermined_directions > 0) {
    constexpr double rotation_cost =
        100;  // turning a sphere about its centre must not pass for a shift of the scan's middle
    Vec6 cost;
    cost << Vec3::Ones(), Vec3::Constant(rotation_cost * rotation_cost);
    const Eigen::MatrixXd free = solver.eigenvectors().leftCols(result.undetermined_directions);
    const Eigen::MatrixXd normal = free.transpose() * cost.asDiagonal() * free;
    const Eigen::VectorXd side = -(free.transpose() * cost.asDiagonal() * (from_believed + result.step));
    result.step += free * normal.ldlt().solve(side);
  }
  return result;
}

}  // namespace vantage
