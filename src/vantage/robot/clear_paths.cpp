#include "vantage/robot/clear_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "vantage/robot/solid_boxes.hpp"

namespace vantage {
namespace {

constexpr int nodes_along_longest_side = 40;

std::vector<Box3> solids_of(const Surroundings& surroundings) {
  std::vector<Box3> boxes = solid_boxes(surroundings.map);
  boxes.insert(boxes.end(), surroundings.obstacles.begin(), surroundings.obstacles.end());
  return boxes;
}

/// A lattice of places over a box, edges between the 26 neighbours, searched by A*.
class Lattice {
 public:
  Lattice(const ClearPaths& space, const Box3& region, double least_spacing) : space_(space) {
    grid_.length = std::max(least_spacing, region.sizes().maxCoeff() / nodes_along_longest_side);
    grid_.min = region.min();
    grid_.size = (region.sizes() / grid_.length).array().floor().matrix().cast<int>() + Index3::Ones();
    const auto nodes = static_cast<std::size_t>(grid_.size.cast<std::int64_t>().prod());
    cost_.assign(nodes, std::numeric_limits<double>::infinity());
    came_from_.assign(nodes, nowhere);
    closed_.assign(nodes, false);
  }

  [[nodiscard]] std::optional<std::vector<Vec3>> path(const Vec3& from, const Vec3& to) {
    for (const std::size_t node : around(from)) {
      if (space_.is_clear(from, place(node))) reach(node, nowhere, (place(node) - from).norm(), to);
    }
    std::vector<std::size_t> last;
    for (const std::size_t node : around(to)) {
      if (space_.is_clear(place(node), to)) last.push_back(node);
    }
    if (last.empty()) return std::nullopt;
    // The last piece goes from any node around the goal to the goal itself; expand until none can improve on the best.
    std::size_t best = nowhere;
    double best_cost = std::numeric_limits<double>::infinity();
    while (!open_.empty() && open_.top().first < best_cost) {
      const std::size_t node = open_.top().second;
      open_.pop();
      if (closed_[node]) continue;
      closed_[node] = true;
      if (std::find(last.begin(), last.end(), node) != last.end()) {
        const double cost = cost_[node] + (to - place(node)).norm();
        if (cost < best_cost) {
          best_cost = cost;
          best = node;
        }
      }
      expand(node, to);
    }
    if (best == nowhere) return std::nullopt;
    std::vector<Vec3> way{to};
    for (std::size_t node = best; node != nowhere; node = came_from_[node]) way.push_back(place(node));
    way.push_back(from);
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  static constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] std::size_t node_at(const Index3& i) const {
    return (static_cast<std::size_t>(i.z()) * static_cast<std::size_t>(grid_.size.y()) +
            static_cast<std::size_t>(i.y())) *
               static_cast<std::size_t>(grid_.size.x()) +
           static_cast<std::size_t>(i.x());
  }
  [[nodiscard]] Index3 index_of(std::size_t node) const {
    const auto nx = static_cast<std::size_t>(grid_.size.x());
    const auto ny = static_cast<std::size_t>(grid_.size.y());
    return {static_cast<int>(node % nx), static_cast<int>(node / nx % ny), static_cast<int>(node / nx / ny)};
  }
  [[nodiscard]] Vec3 place(std::size_t node) const { return grid_.corner(index_of(node)); }

  /// The nodes at the corners of the cell that holds a point.
  [[nodiscard]] std::vector<std::size_t> around(const Vec3& point) const {
    std::vector<std::size_t> nodes;
    const Index3 first = grid_.index_of(point);
    for (int corner = 0; corner < 8; ++corner) {
      const Index3 index = first + Index3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      if (grid_.contains(index)) nodes.push_back(node_at(index));
    }
    return nodes;
  }

  void reach(std::size_t node, std::size_t from, double cost, const Vec3& to) {
    if (cost >= cost_[node]) return;
    cost_[node] = cost;
    came_from_[node] = from;
    open_.emplace(cost + (to - place(node)).norm(), node);
  }

  void expand(std::size_t node, const Vec3& to) {
    const Index3 index = index_of(node);
    const Vec3 here = place(node);
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          const Index3 next = index + Index3(x, y, z);
          if (!grid_.contains(next) || closed_[node_at(next)]) continue;
          const Vec3 there = grid_.corner(next);
          const double cost = cost_[node] + (there - here).norm();
          if (cost < cost_[node_at(next)] && space_.is_clear(here, there)) reach(node_at(next), node, cost, to);
        }
      }
    }
  }

  using Entry = std::pair<double, std::size_t>;  // least cost of a way through the node; ties by the lower node
  const ClearPaths& space_;
  Grid grid_;
  std::vector<double> cost_;
  std::vector<std::size_t> came_from_;
  std::vector<bool> closed_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

}  // namespace

ClearPaths::ClearPaths(const Surroundings& surroundings, double radius, const std::optional<Box3>& workspace)
    : solids_(solids_of(surroundings)),
      radius_(radius),
      least_room_(surroundings.map.grid().length / 20),
      workspace_(workspace) {}

bool ClearPaths::is_clear(const Vec3& from, const Vec3& to) const {
  // The workspace is convex: a way between two places in it stays in it.
  if (workspace_ && !(workspace_->contains(from) && workspace_->contains(to))) return false;
  const double length = (to - from).norm();
  const Vec3 direction = length > 0 ? Vec3((to - from) / length) : Vec3::Zero();
  double at = 0;
  while (true) {
    const double free = room(from + at * direction);
    if (!(free >= least_room_)) return false;
    if (at >= length) return true;
    at = std::min(length, at + free);
  }
}

std::optional<std::vector<Vec3>> ClearPaths::path(const Vec3& from, const Vec3& to) const {
  if (is_clear(from, to)) return std::vector<Vec3>{from, to};
  if (!is_clear(from, from) || !is_clear(to, to)) return std::nullopt;
  Box3 region = solids_.bounds();
  region.extend(from).extend(to);
  const Vec3 margin = Vec3::Constant(2 * radius_ + 0.1 * region.sizes().maxCoeff());
  region = Box3(region.min() - margin, region.max() + margin);
  if (workspace_) region = region.intersection(*workspace_);
  auto way = Lattice(*this, region, 20 * least_room_).path(from, to);
  if (!way) return std::nullopt;
  return pulled_tight(*way);
}

std::vector<Vec3> ClearPaths::shortcut(const std::vector<Vec3>& way) const {
  std::vector<Vec3> corners{way.front()};
  for (std::size_t at = 0; at + 1 < way.size();) {
    std::size_t next = way.size() - 1;
    while (next > at + 1 && !is_clear(way[at], way[next])) --next;
    corners.push_back(way[next]);
    at = next;
  }
  return corners;
}

Vec3 ClearPaths::slid(const Vec3& before, const Vec3& corner, const Vec3& after) const {
  const Vec3 line = after - before;
  const double share = std::clamp((corner - before).dot(line) / std::max(line.squaredNorm(), 1e-300), 0.0, 1.0);
  const Vec3 ideal = before + share * line;
  for (double step = 1; step > 0.01; step /= 2) {
    const Vec3 moved = corner + step * (ideal - corner);
    if (is_clear(before, moved) && is_clear(moved, after)) return moved;
  }
  return corner;
}

std::vector<Vec3> ClearPaths::pulled_tight(const std::vector<Vec3>& way) const {
  constexpr int halvings = 3;
  constexpr int rounds = 8;
  std::vector<Vec3> corners = shortcut(way);
  for (int halving = 0; halving < halvings; ++halving) {
    std::vector<Vec3> finer{corners.front()};
    for (std::size_t i = 1; i < corners.size(); ++i) {
      finer.push_back((corners[i - 1] + corners[i]) / 2);
      finer.push_back(corners[i]);
    }
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t i = 1; i + 1 < finer.size(); ++i) finer[i] = slid(finer[i - 1], finer[i], finer[i + 1]);
    }
    corners = shortcut(finer);
  }
  return corners;
}

double length_of(const std::vector<Vec3>& way) {
  double length = 0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  return length;
}

}  // namespace vantage
