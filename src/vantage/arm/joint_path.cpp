#include "vantage/arm/joint_path.hpp"

#include <algorithm>
#include <limits>

namespace vantage {
namespace {

constexpr std::size_t no_parent = std::numeric_limits<std::size_t>::max();

struct Node {
  Eigen::VectorXd joints;
  std::size_t parent;
};
using Tree = std::vector<Node>;

std::size_t nearest(const JointSpace& space, const Tree& tree, const Eigen::VectorXd& joints) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const double distance = space.distance(tree[i].joints, joints);
    if (distance < least) {
      least = distance;
      best = i;
    }
  }
  return best;
}

enum class Growth { stuck, advanced, arrived };

/// One piece from the tree's nearest node towards `joints`.
Growth extend(const JointSpace& space, Tree& tree, const Eigen::VectorXd& joints) {
  const std::size_t from = nearest(space, tree, joints);
  const double distance = space.distance(tree[from].joints, joints);
  const bool arrives = distance <= space.step;
  const Eigen::VectorXd to =
      arrives ? joints : Eigen::VectorXd(tree[from].joints + (space.step / distance) * (joints - tree[from].joints));
  if (!space.is_clear(tree[from].joints, to)) return Growth::stuck;
  tree.push_back({to, from});
  return arrives ? Growth::arrived : Growth::advanced;
}

JointPath to_root(const Tree& tree) {
  JointPath path;
  for (std::size_t node = tree.size() - 1; node != no_parent; node = tree[node].parent) {
    path.push_back(tree[node].joints);
  }
  return path;
}

/// A place on the path and the corner before it.
struct Place {
  std::size_t corner;
  Eigen::VectorXd joints;
};

Place random_place(const JointPath& path, Random& random) {
  const auto corner = static_cast<std::size_t>(random.index(static_cast<int>(path.size()) - 1));
  return {corner, path[corner] + random.uniform() * (path[corner + 1] - path[corner])};
}

JointPath shortened(const JointSpace& space, JointPath path, Random& random) {
  for (int i = 0; i < space.shortcuts && path.size() > 2; ++i) {
    Place a = random_place(path, random);
    Place b = random_place(path, random);
    if (a.corner > b.corner) std::swap(a, b);
    if (a.corner == b.corner || !space.is_clear(a.joints, b.joints)) continue;
    JointPath shorter(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(a.corner) + 1);
    shorter.push_back(a.joints);
    shorter.push_back(b.joints);
    shorter.insert(shorter.end(), path.begin() + static_cast<std::ptrdiff_t>(b.corner) + 1, path.end());
    path = std::move(shorter);
  }
  // Corners that nobody needs any more.
  for (std::size_t i = 1; i + 1 < path.size();) {
    if (space.is_clear(path[i - 1], path[i + 1])) {
      path.erase(path.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  return path;
}

}  // namespace

double JointSpace::length(const JointPath& path) const {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += distance(path[i - 1], path[i]);
  return sum;
}

std::optional<JointPath> connect(const JointSpace& space, const Eigen::VectorXd& start,
                                 const std::vector<Eigen::VectorXd>& goals, Random& random) {
  Tree from_start{{start, no_parent}};
  Tree from_goals;
  for (const Eigen::VectorXd& goal : goals) from_goals.push_back({goal, no_parent});
  if (from_goals.empty()) return std::nullopt;
  Tree* growing = &from_start;
  Tree* other = &from_goals;
  const auto most = static_cast<std::size_t>(space.most_nodes);
  for (std::size_t tries = 0; tries < most && from_start.size() + from_goals.size() < most; ++tries) {
    Eigen::VectorXd target(start.size());
    for (Eigen::Index j = 0; j < target.size(); ++j) target[j] = random.uniform(space.lower[j], space.upper[j]);
    if (extend(space, *growing, target) != Growth::stuck) {
      const Eigen::VectorXd reached = growing->back().joints;
      Growth growth = Growth::advanced;
      while (growth == Growth::advanced) growth = extend(space, *other, reached);
      if (growth == Growth::arrived) {
        JointPath path = to_root(from_start);
        std::reverse(path.begin(), path.end());
        const JointPath rest = to_root(from_goals);
        path.insert(path.end(), rest.begin() + 1, rest.end());
        return shortened(space, std::move(path), random);
      }
    }
    std::swap(growing, other);
  }
  return std::nullopt;
}

}  // namespace vantage
