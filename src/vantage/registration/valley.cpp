#include "vantage/registration/valley.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage {
namespace {

/// Mean of the squared distances that a step moves the samples by, as a form in the step.
Mat6 squares_of_motion(const Pose& pose, std::span<const SurfaceSample> samples) {
  Mat6 sum = Mat6::Zero();
  const std::size_t stride = samples.size() / 500 + 1;
  double count = 0;
  for (std::size_t i = 0; i < samples.size(); i += stride, ++count) {
    const Eigen::Matrix<double, 3, 6> effect = effect_at(pose.linear() * samples[i].point).topRows<3>();
    sum += effect.transpose() * effect;
  }
  return sum / std::max(1.0, count);
}

/// Turned about the main axes of the samples through their middle.
std::vector<Pose> turned_about_axes(const Pose& pose, std::span<const SurfaceSample> samples) {
  Vec3 middle = Vec3::Zero();
  for (const SurfaceSample& sample : samples) middle += sample.point / static_cast<double>(samples.size());
  Mat3 squares = Mat3::Zero();
  for (const SurfaceSample& sample : samples) {
    const Vec3 offset = sample.point - middle;
    squares += offset * offset.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(squares);
  std::vector<Pose> poses;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double angle : {90.0, 120.0, 180.0, 240.0, 270.0}) {
      const Mat3 turn = Eigen::AngleAxisd(radians(angle), solver.eigenvectors().col(axis)).toRotationMatrix();
      Pose in_sensor = Pose::Identity();
      in_sensor.linear() = turn;
      in_sensor.translation() = middle - turn * middle;
      poses.push_back(pose * in_sensor);
    }
  }
  return poses;
}

/// A motion that turns by less than this while it moves by a metre is a straight one.
constexpr double least_turn = 1e-3;  // radians per metre

}  // namespace

Pose ScanMotion::moved(const Pose& pose, double distance) const {
  const Vec3 velocity = step.head<3>(), turning = step.tail<3>();
  const double speed = turning.norm();
  if (speed < least_turn) return stepped(pose, distance * step);
  const Vec3 axis = turning / speed;
  const Vec3 on_axis = pose.translation() + turning.cross(velocity) / (speed * speed);
  Pose motion = Pose::Identity();
  motion.linear() = Eigen::AngleAxisd(speed * distance, axis).toRotationMatrix();
  motion.translation() = on_axis - motion.linear() * on_axis + distance * axis.dot(velocity) * axis;
  return motion * pose;
}

std::vector<ScanMotion> motions_of_error(const PoseEstimate& world_from_sensor,
                                         std::span<const SurfaceSample> samples) {
  const auto root = root_of_variances(world_from_sensor.covariance);
  std::vector<ScanMotion> motions;
  if (root.cols() == 0 || samples.empty()) return motions;
  const Eigen::MatrixXd squares = root.transpose() * squares_of_motion(world_from_sensor.mean, samples) * root;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(squares);
  for (Eigen::Index k = root.cols() - 1; k >= 0; --k) {
    const double deviation = std::sqrt(std::max(0.0, solver.eigenvalues()[k]));
    if (deviation > 0) motions.push_back({root * solver.eigenvectors().col(k) / deviation, deviation});
  }
  return motions;
}

std::vector<Pose> poses_along_valleys(const PoseEstimate& world_from_sensor, std::span<const SurfaceSample> samples,
                                      double resolution) {
  std::vector<Pose> poses = turned_about_axes(world_from_sensor.mean, samples);
  const std::vector<ScanMotion> motions = motions_of_error(world_from_sensor, samples);
  constexpr std::size_t least_known = 3;
  for (std::size_t k = 0; k < std::min(least_known, motions.size()); ++k) {
    std::vector<double> distances;
    for (const double times : {3.0, 6.0, 12.0, 24.0}) distances.push_back(times * resolution);
    const double turning = motions[k].step.tail<3>().norm();
    if (turning >= least_turn) {
      std::erase_if(distances, [&](double distance) { return distance * turning > std::numbers::pi; });
      for (const double part : {0.25, 1 / 3.0, 0.5, 2 / 3.0, 0.75, 1.0})
        distances.push_back(part * std::numbers::pi / turning);
    }
    for (const double distance : distances) {
      poses.push_back(motions[k].moved(world_from_sensor.mean, distance));
      poses.push_back(motions[k].moved(world_from_sensor.mean, -distance));
    }
  }
  return poses;
}

}  // namespace vantage
