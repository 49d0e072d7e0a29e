#include "vantage/doctor/pose_errors.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "vantage/core/error.hpp"
#include "vantage/core/order_statistics.hpp"
#include "vantage/doctor/consistency.hpp"
#include "vantage/doctor/misplaced.hpp"
#include "vantage/registration/registration.hpp"

namespace vantage {
namespace {

// A frame whose agreement is less than this part of the median frame's stands elsewhere. Measured: the worst frame has
// 0.50 of the median in ur5_tray and 0.88 in apc_shelf; one frame put 0.3 m off has 0.23 and 0.05.
constexpr double astray = 0.35;

// As explain() measured: frames that fit contradict each other in less than this.
constexpr double most_contradiction = 0.2;
constexpr double nothing_common = 0.02;
constexpr double contradicted = 0.1;  // a frame alone, which the others see less of

/// What registration sees of a frame, and what it believes of its pose where that is off by at most `pose_error`.
ScanSurface surface_of(const PointCloud& cloud) {
  const Vec3 sensor = Vec3::Zero();
  return scan_surface(cloud, {&sensor, 1}, std::nullopt);
}
PoseEstimate believed(const Pose& pose, double pose_error) {
  return PoseEstimate::around(pose, pose_error / 3, radians(5) / 3);
}

struct Registered {
  Reading reading;
  std::size_t frames = 0;  // that could be registered
};

/// The reading with frames registered as `vantage plan` would: each against all before it, within `pose_error` of where
/// it is believed; frames that registration refuses stay. `moves` says which frames may move; the others come first.
Registered registered(const Evidence& evidence, const Reading& reading, double pose_error,
                      const std::function<bool(std::size_t)>& moves) {
  Registered result{reading, 0};
  if (evidence.median_depth() <= 0) return result;
  RegisteredSurface model;
  for (std::size_t i = 0; i < evidence.frames.size(); ++i) {
    if (!moves(i)) model.merge(surface_of(points_of(evidence.frames[i], reading)), reading.world_from_sensor[i]);
  }
  for (std::size_t i = 0; i < evidence.frames.size(); ++i) {
    if (!moves(i)) continue;
    const ScanSurface surface = surface_of(points_of(evidence.frames[i], reading));
    Pose& pose = result.reading.world_from_sensor[i];
    if (!model.empty()) {
      const Registration found = register_scan(model, surface, believed(pose, pose_error));
      if (found.succeeded()) {
        pose = found.world_from_sensor;
        ++result.frames;
      }
    }
    model.merge(surface, pose);
  }
  return result;
}

std::string percent(double share) { return concat(std::round(1000 * share) / 10, " %"); }

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Whether frames contradict each other, or see nothing in common.
bool is_contradicted(const Consistency& consistency) {
  return consistency.contradiction() > most_contradiction ||
         (consistency.agrees < nothing_common && consistency.hidden < nothing_common);
}

std::vector<Finding> check_all(const Evidence& evidence, const Reading& reading, double pose_error, double as_given) {
  const Registered tried = registered(evidence, reading, pose_error, [](std::size_t) { return true; });
  const double share = agreement(evidence, tried.reading);
  if (!is_contradicted(consistency(evidence, tried.reading))) return {};
  return {{"pose-errors",
           concat("the frames do not fit each other, no simple mistake explains it, and registration, which searches ",
                  pose_error, " m, does not put it right: the poses are likely off by more"),
           "calibrate the hand-eye transform again, see that each pose is of its frame's moment, or give a larger "
           "--pose-error where the robot is known to be that far off",
           concat("frames share ", percent(as_given), " of their points as given, and ", percent(share), " after ",
                  tried.frames, " of ", evidence.frames.size(), " were registered to those before")}};
}

std::string in_metres(const Vec3& offset) {
  const auto rounded = [](double metres) { return std::round(100 * metres) / 100 + 0.0; };
  return concat("(", rounded(offset.x()), ", ", rounded(offset.y()), ", ", rounded(offset.z()), ") m");
}

/// Frames that share enough with the others where they stand, but fit them better elsewhere.
std::vector<Finding> check_misplaced(const Evidence& evidence, const Reading& reading, double pose_error) {
  std::vector<Finding> findings;
  for (const Misplaced& each : misplaced_frames(evidence, reading, pose_error)) {
    const std::string& name = evidence.frames[each.frame].name;
    findings.push_back(
        {"pose-errors",
         concat("frame ", name, " stands elsewhere than the others, by about ", in_metres(each.offset),
                ", more than the ", pose_error, " m that registration searches"),
         concat("take frame ", name, " again or leave it out"),
         concat("as given, ", percent(each.before),
                " of the points that it and another frame look at float in front of what the other sees; "
                "moved back, ",
                percent(each.after), ", and it shares ", percent(each.agreed_then), " of its points instead of ",
                percent(each.agreement))});
  }
  return findings;
}

/// The frames that alone are off, by name.
std::vector<Finding> check_frames(const Evidence& evidence, const Reading& reading, double pose_error,
                                  const std::vector<double>& shares, double typical) {
  // A frame from the other side of a thing shares little, too, as what it sees is hidden from the others; one that is
  // off is contradicted, or has nothing to do with what the others look at.
  const std::vector<Consistency> fits = consistency_of_frames(evidence, reading);
  const auto is_off = [&](std::size_t i) {
    const bool looks_past = fits[i].looked_at() + fits[i].hidden < nothing_common;
    return shares[i] < astray * typical && (fits[i].contradiction() > contradicted || looks_past);
  };
  std::vector<double> corrected;
  std::vector<std::size_t> indices(shares.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  if (std::any_of(indices.begin(), indices.end(), is_off)) {
    corrected = agreement_of_frames(evidence, registered(evidence, reading, pose_error, is_off).reading);
  }
  std::vector<std::string> off;
  double best = 0;
  for (std::size_t i = 0; i < corrected.size(); ++i) {
    if (!is_off(i) || corrected[i] >= astray * typical) continue;
    off.push_back(evidence.frames[i].name);
    best = std::max(best, corrected[i]);
  }
  if (off.empty()) return check_misplaced(evidence, reading, pose_error);
  return {{"pose-errors",
           concat(off.size(), " of ", shares.size(), " frames stand elsewhere than the others, by more than the ",
                  pose_error, " m that registration searches: ", list_of(off)),
           concat("take these frames again or leave them out: ", list_of(off)),
           concat("they share at most ", percent(best),
                  " of their points with the others, also once registered; a "
                  "frame typically shares ",
                  percent(typical))}};
}

}  // namespace

std::vector<Finding> check_pose_errors(const Evidence& evidence, const Reading& reading, double pose_error) {
  if (evidence.frames.size() < 3) return {};
  const std::vector<double> shares = agreement_of_frames(evidence, reading);
  const double typical = upper_median(shares);
  const bool do_all_contradict = is_contradicted(consistency(evidence, reading));
  // A single frame that is far off contradicts many others, and naming it says more than that the set does not fit.
  std::vector<Finding> named = check_frames(evidence, reading, pose_error, shares, typical);
  if (!do_all_contradict || named.size() == 1) return named;
  return check_all(evidence, reading, pose_error, typical);
}

}  // namespace vantage
