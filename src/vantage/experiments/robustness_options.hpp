#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/experiments/sweep_object.hpp"

namespace vantage {

/// What `experiment robustness` runs.
struct RobustnessOptions {
  int seeds = 2;                        // runs per object, error and registration
  int first_seed = 1;                   // the runs have this seed and the ones after it
  std::string errors = "0.05:2,0.1:5";  // metres:degrees, one standard deviation per axis
  std::string registrations = "icp,truth,none";
  DepthDeviation depth_noise{0.002, 0.001};
  std::string utility = "gain";

  /// Throws InputError naming the option.
  void validate() const;
  struct Deviation {
    double position = 0;     // metres
    double orientation = 0;  // degrees
  };
  [[nodiscard]] std::vector<Deviation> deviations() const;
  [[nodiscard]] std::vector<std::string> registration_list() const;
  /// The options of a run but for its seed and start.
  [[nodiscard]] ReconstructOptions run_options(const Deviation& error, const std::string& registration) const;
};

template <class Field>
void describe(RobustnessOptions& o, Field&& field) {
  field("robustness-seeds", o.seeds, "", "of robustness: runs per object, error and registration");
  field("robustness-first-seed", o.first_seed, "", "of robustness: seed of the first of them; the others follow");
  field("robustness-errors", o.errors, "m:degrees",
        "of robustness: standard deviations per axis of position and orientation, separated by commas");
  field("robustness-registrations", o.registrations, "", "of robustness: any of icp, truth and none");
  field("robustness-depth-noise", o.depth_noise, "m, 1/m",
        "of robustness: A,B, standard deviation of a depth z is A + B z^2");
  field("robustness-utility", o.utility, "", "of robustness: how views are judged");
}

/// The paper's objects; where the folder has none of them, all of its meshes, scaled to the size of the paper's.
[[nodiscard]] std::vector<std::shared_ptr<const SweepObject>> robustness_objects(
    const std::optional<std::filesystem::path>& folder);

}  // namespace vantage
