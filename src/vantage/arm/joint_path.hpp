#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "vantage/core/random.hpp"

namespace vantage {

/// A corner path through joint space; the joints move straight from one corner to the next.
using JointPath = std::vector<Eigen::VectorXd>;

/// What is searched: where the joints may be, how far apart two places are, and what is free.
struct JointSpace {
  Eigen::VectorXd lower, upper;
  Eigen::VectorXd weights;  // the distance is the length of the weighted difference
  std::function<bool(const Eigen::VectorXd& from, const Eigen::VectorXd& to)> is_clear;  // the straight move
  int most_nodes = 2000;                                                                 // of both trees
  double step = 0.5;   // longest piece of a tree, in units of the distance
  int shortcuts = 60;  // tried on a path that was found

  [[nodiscard]] double distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return (b - a).cwiseProduct(weights).norm();
  }
  [[nodiscard]] double length(const JointPath& path) const;
};

/// A path from `start` to one of the goals, or nothing where none was found in time: two trees grow towards each other
/// from random places (RRT-Connect, Kuffner and LaValle 2000), then random shortcuts are taken. All places must be
/// clear. The same random numbers give the same path.
[[nodiscard]] std::optional<JointPath> connect(const JointSpace& space, const Eigen::VectorXd& start,
                                               const std::vector<Eigen::VectorXd>& goals, Random& random);

}  // namespace vantage
