#include "vantage/doctor/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr double tolerance = 0.02;             // of a frame's median depth
constexpr std::size_t points_asked = 150;      // of each frame, in every pair
constexpr std::size_t most_frames_asked = 24;  // partners of a frame, evenly picked

/// The cells of a lattice that hold a point. A query finds points up to one and a half cells away, and all up to half a
/// cell.
class Cells {
 public:
  Cells(const std::vector<Vec3>& points, double side) : side_(side), table_(table_size(points.size()), empty) {
    for (const Vec3& point : points) {
      const std::uint64_t key = key_of((point / side_).array().floor().matrix());
      std::size_t slot = slot_of(key);
      while (table_[slot] != empty && table_[slot] != key) slot = (slot + 1) & (table_.size() - 1);
      table_[slot] = key;
    }
  }

  [[nodiscard]] bool has_near(const Vec3& query) const {
    if (!(query.cwiseAbs().maxCoeff() < reach * side_)) return false;
    const Vec3 first = (query / side_ - Vec3::Constant(0.5)).array().floor();
    for (int corner = 0; corner < 8; ++corner) {
      if (has(key_of(first + Vec3(corner & 1, (corner >> 1) & 1, corner >> 2)))) return true;
    }
    return false;
  }

 private:
  static constexpr std::uint64_t empty = ~std::uint64_t{0};
  static constexpr double reach = 1 << 20;  // cells; 21 bits per axis

  [[nodiscard]] static std::size_t table_size(std::size_t points) {
    std::size_t size = 16;
    while (size < 3 * points) size *= 2;
    return size;
  }
  [[nodiscard]] static std::uint64_t key_of(const Vec3& cell) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      key = key << 21U | (static_cast<std::uint64_t>(std::clamp(cell[axis], 2 - reach, reach - 2) + reach) & 0x1fffff);
    }
    return key;
  }
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const {
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15U) >> 32U) & (table_.size() - 1);
  }
  [[nodiscard]] bool has(std::uint64_t key) const {
    for (std::size_t slot = slot_of(key); table_[slot] != empty; slot = (slot + 1) & (table_.size() - 1)) {
      if (table_[slot] == key) return true;
    }
    return false;
  }

  double side_;
  std::vector<std::uint64_t> table_;
};

std::vector<Vec3> read(const FrameEvidence& frame, const Reading& reading) {
  std::vector<Vec3> points = frame.cloud.points;
  for (Vec3& point : points) point = reading.point_of(point);
  return points;
}

/// Share of the points of `frame` that `other` has too.
double share(const std::vector<Vec3>& points, const Pose& other_from_frame, const Cells& other) {
  if (points.empty()) return 0;
  const std::size_t step = points.size() / points_asked + 1;
  std::size_t asked = 0, found = 0;
  for (std::size_t i = 0; i < points.size(); i += step, ++asked) {
    found += other.has_near(other_from_frame * points[i]) ? 1 : 0;
  }
  return static_cast<double>(found) / static_cast<double>(asked);
}

std::optional<Cells> cells_of(const FrameEvidence& frame, const Reading& reading) {
  if (frame.cloud.points.empty()) return std::nullopt;
  return std::optional<Cells>(std::in_place, read(frame, reading),
                              2 * tolerance * reading.depth_of(frame.median_depth, Eigen::Vector2d::Zero()));
}

/// Every frame asks those right before and after it, which see most of the same, and an even choice of all others.
bool is_asked(std::size_t frame, std::size_t other, std::size_t count) {
  const std::size_t apart = frame > other ? frame - other : other - frame;
  return apart != 0 && (apart <= 2 || apart % (count / most_frames_asked + 1) == 0);
}

double share_of_frame(std::size_t frame, const std::vector<Vec3>& points, const Reading& reading,
                      const std::vector<std::optional<Cells>>& cells) {
  double sum = 0;
  std::size_t pairs = 0;
  for (std::size_t j = 0; j < cells.size(); ++j) {
    if (!cells[j] || !is_asked(frame, j, cells.size())) continue;
    const Pose other_from_frame = reading.world_from_sensor[j].inverse() * reading.world_from_sensor[frame];
    sum += share(points, other_from_frame, *cells[j]);
    ++pairs;
  }
  return pairs == 0 ? 0 : sum / static_cast<double>(pairs);
}

}  // namespace

double agreement_of_frame(const Evidence& evidence, const Reading& reading, std::size_t frame) {
  std::vector<std::optional<Cells>> cells(evidence.frames.size());
  for (std::size_t j = 0; j < cells.size(); ++j) {
    if (is_asked(frame, j, cells.size())) cells[j] = cells_of(evidence.frames[j], reading);
  }
  return share_of_frame(frame, read(evidence.frames[frame], reading), reading, cells);
}

std::vector<double> agreement_of_frames(const Evidence& evidence, const Reading& reading) {
  const std::size_t count = evidence.frames.size();
  std::vector<std::optional<Cells>> cells(count);
  parallel_for(count, [&](std::size_t i) { cells[i] = cells_of(evidence.frames[i], reading); });
  std::vector<double> shares(count, 0.0);
  parallel_for(
      count, [&](std::size_t i) { shares[i] = share_of_frame(i, read(evidence.frames[i], reading), reading, cells); });
  return shares;
}

double agreement(const Evidence& evidence, const Reading& reading) {
  const std::vector<double> shares = agreement_of_frames(evidence, reading);
  double sum = 0;
  for (const double each : shares) sum += each;
  return shares.empty() ? 0 : sum / static_cast<double>(shares.size());
}

}  // namespace vantage
