#include "vantage/doctor/consistency.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/parallel.hpp"
#include "vantage/doctor/agreement.hpp"

namespace vantage {
namespace {

constexpr double tolerated = 0.02;            // of the other frame's median depth
constexpr double thin = 0.003;                // of the other frame's median depth: walls that depths can tell apart
constexpr double behind = 0.2;                // cosine from which on a surface is seen from its back
constexpr std::size_t points_compared = 400;  // of each frame, in every pair
constexpr std::size_t partners = 8;           // of a frame, evenly picked, besides those next to it

struct Points {
  std::vector<Vec3> points, normals;  // sensor frame, metres
};

/// An even choice of the points of a frame; of those with a normal, where most have one: others lie on edges.
Points chosen_points(const FrameEvidence& frame, const Reading& reading) {
  const PointCloud all = points_of(frame, reading);
  const auto with_normal = static_cast<std::size_t>(
      std::count_if(all.normals.begin(), all.normals.end(), [](const Vec3& normal) { return !normal.isZero(0); }));
  const bool only_with_normal = 2 * with_normal > all.size();
  const std::size_t step = (only_with_normal ? with_normal : all.size()) / points_compared + 1;
  Points chosen;
  std::size_t counted = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (only_with_normal && all.normals[i].isZero(0)) continue;
    if (counted++ % step != 0 || !all.points[i].allFinite()) continue;
    chosen.points.push_back(all.points[i]);
    chosen.normals.push_back(all.normals[i]);
  }
  return chosen;
}

bool is_partner(std::size_t frame, std::size_t other, std::size_t count) {
  const std::size_t apart = frame > other ? frame - other : other - frame;
  return apart != 0 && (apart <= 2 || apart % (count / partners + 1) == 0);
}

struct DepthsSeen {
  double least = 0, most = 0;  // metres
};

/// What a frame sees around a point in its sensor frame; nothing where it cannot say.
std::optional<DepthsSeen> seen_at(const FrameEvidence& frame, const Reading& reading, const Vec3& point) {
  if (!(point.z() > 0)) return std::nullopt;
  const Eigen::Vector2d tangent = point.head<2>() / point.z();
  const auto range = frame.map.around((tangent - reading.tangent_shift).cwiseQuotient(reading.tangent_scale));
  if (!range) return std::nullopt;
  const double a = reading.depth_of(range->least, tangent), b = reading.depth_of(range->most, tangent);
  return DepthsSeen{std::min(a, b), std::max(a, b)};
}

struct Counts {
  std::size_t asked = 0, agrees = 0, floats = 0, backwards = 0, hidden = 0;

  Counts& operator+=(const Counts& other) {
    asked += other.asked;
    agrees += other.agrees;
    floats += other.floats;
    backwards += other.backwards;
    hidden += other.hidden;
    return *this;
  }
  [[nodiscard]] Consistency shares() const {
    if (asked == 0) return {};
    const auto of_asked = [&](std::size_t n) { return static_cast<double>(n) / static_cast<double>(asked); };
    return {of_asked(agrees), of_asked(floats), of_asked(backwards), of_asked(hidden)};
  }
};

/// All frames as points and maps in one reading.
class ComparedFrames {
 public:
  ComparedFrames(const Evidence& evidence, const Reading& reading) : evidence_(evidence), reading_(reading) {
    points_.resize(evidence.frames.size());
    parallel_for(points_.size(), [&](std::size_t i) { points_[i] = chosen_points(evidence.frames[i], reading); });
  }

  [[nodiscard]] Counts ask(std::size_t frame, std::size_t other) const {
    const Pose other_from_frame = reading_.world_from_sensor[other].inverse() * reading_.world_from_sensor[frame];
    const double median = reading_.depth_of(evidence_.frames[other].median_depth, Eigen::Vector2d::Zero());
    const double slack = tolerated * median;
    Counts counts;
    for (std::size_t i = 0; i < points_[frame].points.size(); ++i) {
      const Vec3 point = other_from_frame * points_[frame].points[i];
      ++counts.asked;
      const std::optional<DepthsSeen> seen = seen_at(evidence_.frames[other], reading_, point);
      if (!seen) continue;
      if (point.z() < seen->least - slack) {
        ++counts.floats;
      } else if (point.z() > seen->most + slack) {
        ++counts.hidden;
      } else {
        const Vec3 normal = other_from_frame.linear() * points_[frame].normals[i];
        const bool is_back = normal.dot(point) > behind * point.norm();
        // The far side of a thin wall lies behind what the other frame sees, also where that is the wall's rim.
        const bool is_far_side =
            is_back && (point.z() > seen->most + thin * median || seen->most - seen->least > slack);
        ++(is_far_side ? counts.hidden : is_back ? counts.backwards : counts.agrees);
      }
    }
    return counts;
  }

  /// Sum over the points of how far they are from what the other frame sees.
  [[nodiscard]] double misfit(std::size_t frame, std::size_t other, double reach) const {
    constexpr double not_seen = 0.6;  // less than far off, more than hidden
    constexpr double hidden = 0.5;
    const Pose other_from_frame = reading_.world_from_sensor[other].inverse() * reading_.world_from_sensor[frame];
    double sum = 0;
    for (const Vec3& each : points_[frame].points) {
      const Vec3 point = other_from_frame * each;
      const std::optional<DepthsSeen> seen = seen_at(evidence_.frames[other], reading_, point);
      if (!seen) {
        sum += not_seen;
      } else if (point.z() < seen->least) {
        sum += std::min(1.0, (seen->least - point.z()) / (reach * point.z()));
      } else if (point.z() > seen->most) {
        sum += std::min(hidden, (point.z() - seen->most) / (reach * point.z()));
      }
    }
    return sum;
  }

  [[nodiscard]] std::size_t count(std::size_t frame) const { return points_[frame].points.size(); }

 private:
  const Evidence& evidence_;
  const Reading& reading_;
  std::vector<Points> points_;
};

}  // namespace

double Consistency::contradiction() const { return looked_at() > 0 ? (floats + backwards) / looked_at() : 0; }

Consistency consistency(const Evidence& evidence, const Reading& reading) {
  const bool sees_nothing = std::all_of(evidence.frames.begin(), evidence.frames.end(),
                                        [](const FrameEvidence& frame) { return frame.map.empty(); });
  if (sees_nothing) return {.agrees = agreement(evidence, reading)};
  const ComparedFrames company(evidence, reading);
  const std::size_t count = evidence.frames.size();
  std::vector<Counts> counts(count);
  parallel_for(count, [&](std::size_t i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (is_partner(i, j, count)) counts[i] += company.ask(i, j);
    }
  });
  Counts all;
  for (const Counts& each : counts) all += each;
  return all.shares();
}

std::vector<Consistency> consistency_of_frames(const Evidence& evidence, const Reading& reading) {
  const ComparedFrames company(evidence, reading);
  const std::size_t count = evidence.frames.size();
  std::vector<Consistency> result(count);
  parallel_for(count, [&](std::size_t i) {
    Counts counts;
    for (std::size_t j = 0; j < count; ++j) {
      if (!is_partner(i, j, count)) continue;
      counts += company.ask(i, j);
      counts += company.ask(j, i);
    }
    result[i] = counts.shares();
  });
  return result;
}

double misfit(const Evidence& evidence, const Reading& reading, double reach) {
  const ComparedFrames company(evidence, reading);
  const std::size_t count = evidence.frames.size();
  std::vector<double> sums(count, 0.0);
  std::vector<std::size_t> asked(count, 0);
  parallel_for(count, [&](std::size_t i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (!is_partner(i, j, count)) continue;
      sums[i] += company.misfit(i, j, reach);
      asked[i] += company.count(i);
    }
  });
  double sum = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += sums[i];
    all += asked[i];
  }
  return all == 0 ? 1 : sum / static_cast<double>(all);
}

}  // namespace vantage
