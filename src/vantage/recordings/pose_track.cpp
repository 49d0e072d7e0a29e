#include "vantage/recordings/pose_track.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/core/order_statistics.hpp"

namespace vantage {
namespace {

constexpr std::int64_t longest_step_ns = 20'000'000;  // to the nearest sample; robots report at 50 Hz or more
// Between samples that are farther apart than this many times their usual distance something was lost.
constexpr std::int64_t lost_samples = 10;
constexpr std::int64_t least_gap_ns = 100'000'000;
// Two poses as near as this are of a sensor that stood still; then the time between them does not matter.
constexpr double still_metres = 1e-3;
constexpr double still_radians = 2e-3;

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

bool are_alike(const PoseTrack::Sample& a, const PoseTrack::Sample& b) {
  return (a.translation - b.translation).norm() <= still_metres &&
         a.rotation.angularDistance(b.rotation) <= still_radians;
}

}  // namespace

Pose PoseTrack::Sample::pose() const {
  Pose pose = Pose::Identity();
  pose.linear() = rotation.toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

void PoseTrack::add(std::int64_t time_ns, std::uint32_t parent, const Pose& parent_from_child) {
  samples_.push_back(
      {time_ns, parent, parent_from_child.translation(), Eigen::Quaterniond(parent_from_child.linear())});
}

void PoseTrack::finish() {
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const Sample& a, const Sample& b) { return a.time_ns < b.time_ns; });
  std::vector<Sample> kept;
  for (const Sample& sample : samples_) {
    if (!kept.empty() && kept.back().time_ns == sample.time_ns) kept.pop_back();
    kept.push_back(sample);
  }
  samples_ = std::move(kept);
  std::vector<std::int64_t> gaps;
  for (std::size_t i = 1; i < samples_.size(); ++i) gaps.push_back(samples_[i].time_ns - samples_[i - 1].time_ns);
  const std::int64_t usual = gaps.empty() ? 0 : upper_median(std::move(gaps));
  longest_gap_ns_ =
      samples_.size() < 2 ? 0 : std::max(least_gap_ns, usual > (1LL << 56) ? usual : lost_samples * usual);
}

double PoseTrack::duration_s() const {
  return samples_.empty() ? 0 : seconds(samples_.back().time_ns - samples_.front().time_ns);
}

bool PoseTrack::moves() const {
  return std::any_of(samples_.begin(), samples_.end(),
                     [&](const Sample& s) { return !are_alike(s, samples_.front()); });
}

std::pair<std::optional<PoseTrack::Sample>, std::string> PoseTrack::at(std::int64_t time_ns) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), time_ns,
                                      [](const Sample& sample, std::int64_t t) { return sample.time_ns < t; });
  if (after != samples_.end() && after->time_ns == time_ns) return {*after, ""};
  if (after != samples_.begin() && after != samples_.end()) return between(*std::prev(after), *after, time_ns);
  if (samples_.empty()) return {std::nullopt, "there is no pose"};
  const bool is_early = after == samples_.begin();
  const Sample& nearest = is_early ? samples_.front() : samples_.back();
  const std::int64_t distance = is_early ? nearest.time_ns - time_ns : time_ns - nearest.time_ns;
  if (distance <= longest_step_ns) return {nearest, ""};
  return {std::nullopt, fmt::format("the {} pose is {:.3f} s {}", is_early ? "first" : "last", seconds(distance),
                                    is_early ? "later" : "earlier")};
}

std::pair<std::optional<PoseTrack::Sample>, std::string> PoseTrack::between(const Sample& before, const Sample& after,
                                                                            std::int64_t time_ns) const {
  const std::int64_t gap = after.time_ns - before.time_ns, into = time_ns - before.time_ns;
  const bool is_near_one = std::min(into, gap - into) <= longest_step_ns;
  const Sample& nearer = 2 * into <= gap ? before : after;
  if (before.parent != after.parent) {
    if (is_near_one) return {nearer, ""};
    return {std::nullopt, "its parent changes at that time"};
  }
  if (gap > longest_gap_ns_ && !are_alike(before, after) && !is_near_one)
    return {std::nullopt, fmt::format("there is no pose for {:.3f} s around it", seconds(gap))};
  const double share = static_cast<double>(into) / static_cast<double>(gap);
  Sample sample{time_ns, before.parent, before.translation + share * (after.translation - before.translation),
                before.rotation.slerp(share, after.rotation)};
  return {sample, ""};
}

}  // namespace vantage
