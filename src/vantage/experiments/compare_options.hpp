#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/experiments/protocol.hpp"
#include "vantage/options/reconstruct_options.hpp"

namespace vantage {

/// What `experiment compare` compares, and under which conditions.
struct CompareOptions {
  std::string utilities = "all";
  std::string shapes = "all";
  std::string baseline = "combined";
  std::optional<std::string> external;
  double external_timeout = 60;
  Eigen::Vector2d depth_noise{0, 0};
  Vec3 positioning_error = Vec3::Zero();
  std::string registration = "truth";
  std::string protocol = "paper";
  std::optional<int> max_views;
  RobotTime time;

  /// Throws InputError naming the option.
  void validate() const;
  /// Names of the methods, the baseline first: utilities, `known-greedy`, `known-optimum`, `external`.
  [[nodiscard]] std::vector<std::string> methods() const;
  /// The runs' options but for object, start and utility.
  [[nodiscard]] ReconstructOptions run_options() const;
  /// Scans that a run may take.
  [[nodiscard]] int budget() const;
};

template <class Field>
void describe(CompareOptions& o, Field&& field) {
  field("utilities", o.utilities, "",
        "of compare: names separated by commas, also known-greedy and known-optimum, which know the object; or all");
  field("shapes", o.shapes, "",
        "of compare: objects separated by commas, the paper's by name or mesh files NAME.ply; or all of the paper's");
  field("baseline", o.baseline, "", "of compare: the utility that the others' differences are counted from");
  field("external", o.external, "", "of compare: a command that is a planner of your own (docs/new-utility.md)");
  field("external-timeout", o.external_timeout, "s", "of compare: how long it may take to answer");
  field("compare-depth-noise", o.depth_noise, "m, 1/m",
        "of compare: A,B, standard deviation of a depth z is A + B z^2");
  field("compare-positioning-error", o.positioning_error, "m", "of compare: standard deviation per axis");
  field("compare-registration", o.registration, "", "of compare: truth, none or icp");
  field("protocol", o.protocol, "", "of compare: " + names_of_protocols() + " (docs/methods.md)");
  field("compare-scan-time", o.time.scan, "s", "of compare: what a scan counts in the time to 99 %");
  field("compare-speed", o.time.speed, "m/s", "of compare: the speed of the path in the time to 99 %");
  field("compare-max-views", o.max_views, "", "of compare: scans after which a run ends; the protocol's if not given");
}

}  // namespace vantage
