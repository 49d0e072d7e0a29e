#include "vantage/recordings/pose_match.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"

namespace vantage {
namespace {

constexpr double longest_gap = 0.02;  // seconds between a frame and its pose; robots report at 50 Hz or more

std::optional<double> time_of(const FrameKey& frame) {
  if (frame.time) return frame.time;
  const auto time = to_double(frame.name);
  return time && std::isfinite(*time) ? time : std::nullopt;
}

bool is_whole_number(const std::string& name) { return to_unsigned(name).has_value(); }

/// The poses that frames get, and how many got one.
class Matching {
 public:
  Matching(const PoseList& list, const std::vector<FrameKey>& frames) : list_(list), frames_(frames) {
    result_.poses.resize(frames.size());
    result_.why_not.resize(frames.size());
  }

  void give(std::size_t frame, const ListedPose* pose, std::string why_not) {
    if (pose != nullptr && pose->world_from_sensor) {
      result_.poses[frame] = pose->world_from_sensor;
      ++matched_;
    } else {
      result_.why_not[frame] =
          pose != nullptr ? "has a pose that is not finite: tracking was lost" : std::move(why_not);
    }
  }

  [[nodiscard]] std::size_t matched() const { return matched_; }

  [[nodiscard]] MatchedPoses result(std::string_view how) && {
    result_.how = fmt::format("{} matched {}", matched_, how);
    return std::move(result_);
  }

  Matching by_time() && {
    std::vector<const ListedPose*> sorted;
    for (const ListedPose& pose : list_.poses) {
      if (pose.time) sorted.push_back(&pose);
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const ListedPose* a, const ListedPose* b) { return *a->time < *b->time; });
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const std::optional<double> time = time_of(frames_[i]);
      const ListedPose* found = time ? nearest(sorted, *time) : nullptr;
      give(i, found, time ? fmt::format("has no pose within {} s", longest_gap) : "has no time");
    }
    return std::move(*this);
  }

  Matching by_order() && {
    for (std::size_t i = 0; i < frames_.size(); ++i)
      give(i, i < list_.poses.size() ? &list_.poses[i] : nullptr, "comes after the last pose");
    return std::move(*this);
  }

  Matching by_number() && {
    std::map<std::int64_t, const ListedPose*> by_number;
    for (std::size_t i = 0; i < list_.poses.size(); ++i) {
      if (const auto number = number_of(i)) by_number.emplace(*number, &list_.poses[i]);
    }
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const std::optional<std::int64_t> number = number_in(frames_[i].name);
      const auto found = number ? by_number.find(*number) : by_number.end();
      give(i, found == by_number.end() ? nullptr : found->second,
           number ? fmt::format("has no pose of number {}", *number) : "has no number in its name");
    }
    return std::move(*this);
  }

 private:
  static const ListedPose* nearest(const std::vector<const ListedPose*>& sorted, double time) {
    const auto after = std::lower_bound(sorted.begin(), sorted.end(), time,
                                        [](const ListedPose* pose, double t) { return *pose->time < t; });
    const ListedPose* found = after == sorted.end() ? nullptr : *after;
    if (after != sorted.begin() && (found == nullptr || time - *(*std::prev(after))->time < *found->time - time))
      found = *std::prev(after);
    return found != nullptr && std::abs(*found->time - time) <= longest_gap ? found : nullptr;
  }

  /// Of the frame that a pose is of; a list without times and numbers counts from 0.
  [[nodiscard]] std::optional<std::int64_t> number_of(std::size_t i) const {
    const ListedPose& pose = list_.poses[i];
    if (pose.number) return pose.number;
    if (!pose.time) return static_cast<std::int64_t>(i);
    const bool is_whole = std::abs(*pose.time) < 1e15 && *pose.time == std::floor(*pose.time);
    return is_whole ? std::optional(static_cast<std::int64_t>(*pose.time)) : std::nullopt;
  }

  const PoseList& list_;
  const std::vector<FrameKey>& frames_;
  MatchedPoses result_;
  std::size_t matched_ = 0;
};

constexpr std::string_view within_gap = "within 20 ms", in_order = "in their order", by_numbers = "by their numbers";

bool has_times(const PoseList& list) {
  return std::any_of(list.poses.begin(), list.poses.end(),
                     [](const ListedPose& pose) { return pose.time.has_value(); });
}

MatchedPoses match_automatically(const PoseList& list, const std::vector<FrameKey>& frames, const std::string& file) {
  const bool counts_agree = list.poses.size() == frames.size();
  const bool are_numbered = std::all_of(frames.begin(), frames.end(), [](const FrameKey& frame) {
    return !frame.time && (is_whole_number(frame.name) || !time_of(frame));
  });
  if (counts_agree && are_numbered) return Matching(list, frames).by_order().result(in_order);
  if (has_times(list)) {
    Matching by_time = Matching(list, frames).by_time();
    if (by_time.matched() > 0) return std::move(by_time).result(within_gap);
  }
  if (counts_agree) return Matching(list, frames).by_order().result(in_order);
  Matching by_number = Matching(list, frames).by_number();
  if (by_number.matched() > 0) return std::move(by_number).result(by_numbers);
  throw InputError(fmt::format(
      "{}: has {} poses for {} scans; must be one each, in their order, or the scans must be named by their times "
      "(within {} s) or numbers; --match order takes the first {}",
      file, list.poses.size(), frames.size(), longest_gap, std::min(list.poses.size(), frames.size())));
}

}  // namespace

std::optional<std::int64_t> number_in(std::string_view name) {
  constexpr std::string_view digits = "0123456789";
  const std::size_t last = name.find_last_of(digits);
  if (last == std::string_view::npos) return std::nullopt;
  const std::size_t before = name.find_last_not_of(digits, last);
  const std::size_t first = before == std::string_view::npos ? 0 : before + 1;
  return to_integer(name.substr(first, last + 1 - first));
}

MatchedPoses match_poses(const PoseList& list, const std::vector<FrameKey>& frames, PoseMatch match,
                         const std::string& file) {
  if (match == PoseMatch::automatic) return match_automatically(list, frames, file);
  const auto matched = [&](Matching matching, std::string_view how) {
    require(matching.matched() > 0, file, ": none of the ", frames.size(), " scans has a pose ", how, "; the first is ",
            in_quotes(frames.empty() ? "" : frames.front().name));
    return std::move(matching).result(how);
  };
  if (match == PoseMatch::order) return matched(Matching(list, frames).by_order(), in_order);
  if (match == PoseMatch::name) return matched(Matching(list, frames).by_number(), by_numbers);
  require(has_times(list), file, ": has no times; --match order or name");
  return matched(Matching(list, frames).by_time(), within_gap);
}

}  // namespace vantage
