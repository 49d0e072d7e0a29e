#include "vantage/doctor/misplaced.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr std::size_t points_moved = 600;      // of each frame, in every pair
constexpr std::size_t most_frames_moved = 24;  // partners of a frame, evenly picked
constexpr double margin = 0.03;                // of a depth: a point that much nearer floats in front
// Measured by examine() on ur5_tray and apc_shelf: untouched frames have 0.02 to 0.07 (one camera that looks along the
// table 0.17, and it fits nowhere better); moved by 0.3 m along the table 0.10 to 0.5, and once put back the former.
constexpr double worth_a_look = 0.08;
constexpr double much_better = 0.65;
constexpr std::array reaches{2.0, 3.0, 4.0, 6.0, 8.0};  // pose errors

std::vector<Vec3> thinned(const std::vector<Vec3>& points) {
  const std::size_t step = points.size() / points_moved + 1;
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
}

struct Seen {
  std::vector<Vec3> points;  // sensor frame, metres
  SightMap map;
};

/// All frames as they see and are seen by one that is moved about.
class Company {
 public:
  Company(const Evidence& evidence, const Reading& reading) : evidence_(evidence), reading_(reading) {
    for (const FrameEvidence& frame : evidence.frames) {
      const PointCloud cloud = points_of(frame, reading);
      seen_.push_back({thinned(cloud.points), SightMap(cloud.points)});
    }
  }

  /// Share of the points of a frame at this pose that lie where others see through, and of others' where it does.
  [[nodiscard]] double conflict(std::size_t frame, const Pose& world_from_frame) const {
    Count count;
    const std::size_t step = seen_.size() / most_frames_moved + 1;
    for (std::size_t other = 0; other < seen_.size(); ++other) {
      const std::size_t apart = other > frame ? other - frame : frame - other;
      if (apart == 0 || (apart > 2 && apart % step != 0)) continue;
      const Pose other_from_frame = reading_.world_from_sensor[other].inverse() * world_from_frame;
      ask(seen_[frame].points, other_from_frame, seen_[other].map, count);
      ask(seen_[other].points, other_from_frame.inverse(), seen_[frame].map, count);
    }
    return count.known == 0 ? 0 : static_cast<double>(count.floating) / static_cast<double>(count.known);
  }

  [[nodiscard]] double agreement(std::size_t frame, const Pose& world_from_frame) const {
    Reading moved = reading_;
    moved.world_from_sensor[frame] = world_from_frame;
    return agreement_of_frame(evidence_, moved, frame);
  }

 private:
  struct Count {
    std::size_t known = 0, floating = 0;
  };
  static void ask(const std::vector<Vec3>& points, const Pose& map_from_points, const SightMap& map, Count& count) {
    for (const Vec3& point : points) {
      const Vec3 there = map_from_points * point;
      const double least = map.least_depth(there);
      if (least <= 0) continue;
      ++count.known;
      count.floating += there.z() < (1 - margin) * least ? 1 : 0;
    }
  }

  const Evidence& evidence_;
  const Reading& reading_;
  std::vector<Seen> seen_;
};

/// The steps to the 26 neighbours in a lattice, of length 1.
std::vector<Vec3> directions() {
  std::vector<Vec3> all;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) all.push_back(Vec3(x, y, z).normalized());
      }
    }
  }
  return all;
}

/// The place where a frame fits best, if it is far from where it stands and fits clearly better.
std::optional<Misplaced> better_place(const Company& company, std::size_t frame, const Pose& believed,
                                      double pose_error) {
  Misplaced found;
  found.frame = frame;
  found.before = company.conflict(frame, believed);
  if (found.before < worth_a_look) return std::nullopt;
  found.agreement = company.agreement(frame, believed);
  double best = 0;
  const auto try_at = [&](const Vec3& shift) {
    const Pose moved = Eigen::Translation3d(shift) * believed;
    const double conflict = company.conflict(frame, moved);
    if (conflict > much_better * found.before) return false;
    const double agreement = company.agreement(frame, moved);
    if (agreement < found.agreement || agreement - conflict <= best) return false;
    best = agreement - conflict;
    found.after = conflict;
    found.agreed_then = agreement;
    found.offset = -shift;
    return true;
  };
  bool is_better = false;
  for (const Vec3& direction : directions()) {
    for (const double reach : reaches) is_better = try_at(reach * pose_error * direction) || is_better;
  }
  if (!is_better) return std::nullopt;
  for (double step = pose_error; step > pose_error / 5; step /= 2) {
    const Vec3 around = -found.offset;
    for (const Vec3& direction : directions()) (void)try_at(around + step * direction);
  }
  if (found.offset.norm() < reaches.front() * pose_error * 0.99) return std::nullopt;
  return found;
}

}  // namespace

SightMap::SightMap(const std::vector<Vec3>& points) {
  Eigen::AlignedBox2d extent;
  std::vector<Vec3> ahead;  // tangents and depth
  for (const Vec3& point : points) {
    if (point.z() <= 0) continue;
    ahead.emplace_back(point.x() / point.z(), point.y() / point.z(), point.z());
    extent.extend(ahead.back().head<2>());
  }
  if (ahead.size() < 16 || extent.volume() <= 0) return;
  // Wider than the points are apart, so that where there is a surface every cell has one.
  cell_ = 1.5 * std::sqrt(extent.volume() / static_cast<double>(ahead.size()));
  first_ = extent.min();
  const Eigen::Vector2d size = extent.sizes() / cell_;
  // A few points far to the side would make it a map of nothing.
  if (size.maxCoeff() > 4096) return;
  columns_ = static_cast<int>(size.x()) + 1;
  rows_ = static_cast<int>(size.y()) + 1;
  const auto at = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  };
  std::vector<float> nearest(at(0, rows_), 0.0F);
  for (const Vec3& each : ahead) {
    const Eigen::Vector2d place = (each.head<2>() - first_) / cell_;
    float& value = nearest[at(static_cast<int>(place.x()), static_cast<int>(place.y()))];
    if (value == 0 || each.z() < value) value = static_cast<float>(each.z());
  }
  least_.assign(nearest.size(), 0.0F);
  for (int row = 1; row + 1 < rows_; ++row) {
    for (int column = 1; column + 1 < columns_; ++column) {
      float least = nearest[at(column, row)];
      for (int dy = -1; dy <= 1; ++dy) {
        // An unknown neighbour, 0, makes the cell unknown.
        for (int dx = -1; dx <= 1; ++dx) least = std::min(least, nearest[at(column + dx, row + dy)]);
      }
      least_[at(column, row)] = least;
    }
  }
}

double SightMap::least_depth(const Vec3& point) const {
  if (least_.empty() || point.z() <= 0) return 0;
  const Eigen::Vector2d place = (point.head<2>() / point.z() - first_) / cell_;
  if (!(place.minCoeff() >= 0) || !(place.x() < columns_) || !(place.y() < rows_)) return 0;
  return static_cast<double>(least_[static_cast<std::size_t>(place.y()) * static_cast<std::size_t>(columns_) +
                                    static_cast<std::size_t>(place.x())]);
}

std::vector<Misplaced> misplaced_frames(const Evidence& evidence, const Reading& reading, double pose_error) {
  const std::size_t count = evidence.frames.size();
  if (count < 3 || pose_error <= 0) return {};
  const Company company(evidence, reading);
  std::vector<std::optional<Misplaced>> places(count);
  parallel_for(count,
               [&](std::size_t i) { places[i] = better_place(company, i, reading.world_from_sensor[i], pose_error); });
  std::vector<Misplaced> found;
  for (const auto& place : places) {
    if (place) found.push_back(*place);
  }
  return found;
}

}  // namespace vantage
