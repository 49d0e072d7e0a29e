#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/geometry.hpp"
#include "vantage/doctor/consistency.hpp"
#include "vantage/doctor/hypothesis.hpp"

namespace vantage {
namespace {

constexpr std::size_t most_frames = 12;  // that are looked at while searching
constexpr int most_rounds = 40;          // of the search at one step width

Reading with_offset(const Reading& base, const Pose& hand_from_sensor) {
  Reading reading = base;
  for (Pose& pose : reading.world_from_sensor) pose = pose * hand_from_sensor;
  return reading;
}

/// The offset turned and moved a little: numbers 0 to 2 move along an axis, 3 to 5 turn about one.
Pose nudged(const Pose& offset, int way, double metres, double angle) {
  const Vec3 axis = Vec3::Unit(way % 3);
  if (way < 3) return Eigen::Translation3d(metres * axis) * offset;
  Pose turned = offset;
  turned.linear() = turned.linear() * Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  return turned;
}

/// Every few frames, so that searches stay short.
Evidence few_frames(const Evidence& evidence) {
  Evidence few;
  few.camera = evidence.camera;
  const std::size_t step = (evidence.frames.size() + most_frames - 1) / most_frames;
  for (std::size_t i = 0; i < evidence.frames.size(); i += step) few.frames.push_back(evidence.frames[i]);
  return few;
}

/// Walks downhill in the misfit, with steps and reach that become smaller.
Pose refined(const Evidence& evidence, const Reading& base, Pose offset, double depth) {
  for (double reach = 0.3; reach > 0.005; reach /= 2) {
    const double metres = 0.5 * reach * depth, angle = 0.5 * reach;
    double least = misfit(evidence, with_offset(base, offset), std::max(reach, 0.015));
    for (int round = 0; round < most_rounds; ++round) {
      const double before = least;
      for (int way = 0; way < 6; ++way) {
        for (const double sign : {1.0, -1.0}) {
          const Pose moved = nudged(offset, way, sign * metres, sign * angle);
          const double found = misfit(evidence, with_offset(base, moved), std::max(reach, 0.015));
          if (found >= least) continue;
          least = found;
          offset = moved;
          break;
        }
      }
      if (least > before - 1e-4) break;
    }
  }
  return offset;
}

/// Rotations by right angles: cameras are mounted in any of them.
std::vector<Pose> starts() {
  std::vector<Pose> all;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Mat3 turn = Mat3::Zero();
      for (int axis = 0; axis < 3; ++axis)
        turn(order[static_cast<std::size_t>(axis)], axis) = (signs >> axis & 1) != 0 ? -1 : 1;
      if (turn.determinant() < 0) continue;
      Pose pose = Pose::Identity();
      pose.linear() = turn;
      all.push_back(pose);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

double rounded(double number, double step) { return std::round(number / step) * step + 0.0; }

std::string option_text(const Pose& offset) {
  const Vec3 t = offset.translation();
  const Eigen::Quaterniond q(Mat3(offset.linear()));
  std::string text;
  for (const double metres : {t.x(), t.y(), t.z()}) text += concat(rounded(metres, 0.0001), ",");
  return text +
         concat(rounded(q.x(), 1e-4), ",", rounded(q.y(), 1e-4), ",", rounded(q.z(), 1e-4), ",", rounded(q.w(), 1e-4));
}

}  // namespace

std::vector<Hypothesis> poses_of_the_hand(const Reading& base, const Evidence& evidence) {
  const Evidence few = few_frames(evidence);
  if (few.frames.size() < 3) return {};
  Reading start = base;
  start.world_from_sensor.clear();
  const std::size_t step = (evidence.frames.size() + most_frames - 1) / most_frames;
  for (std::size_t i = 0; i < evidence.frames.size(); i += step)
    start.world_from_sensor.push_back(base.world_from_sensor[i]);
  const double depth = base.depth_of(evidence.median_depth(), Eigen::Vector2d::Zero());

  std::vector<std::pair<double, Pose>> tried;
  for (const Pose& turn : starts()) tried.emplace_back(misfit(few, with_offset(start, turn), 0.3), turn);
  // A sensor that hardly turns against the hand comes first.
  std::stable_sort(tried.begin() + 1, tried.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  constexpr std::size_t best_starts = 4;
  constexpr double like_first = 1.05;  // of equals the first
  Pose best = Pose::Identity();
  double highest = -1;
  for (std::size_t i = 0; i < std::min(best_starts, tried.size()); ++i) {
    const Pose offset = refined(few, start, tried[i].second, depth);
    const double score = consistency(few, with_offset(start, offset)).score();
    if (score <= like_first * highest) continue;
    highest = score;
    best = offset;
  }
  const double angle = degrees(Eigen::AngleAxisd(Mat3(best.linear())).angle());
  Hypothesis hand{
      "hand-eye",
      concat("the poses are those of the robot's hand: the sensor sits ", rounded(best.translation().norm(), 0.001),
             " m from it, turned by ", rounded(angle, 0.1), " degrees"),
      concat("give the pose of the sensor in the hand; as far as these frames show it: --hand-eye=", option_text(best)),
      with_offset(base, best)};
  return {hand};
}

}  // namespace vantage
