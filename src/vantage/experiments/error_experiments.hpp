#pragma once

#include "vantage/experiments/experiments.hpp"

// Experiments beyond the paper's: robots that turn, errors that are not known, scans that have to be registered.
namespace vantage {

/// `orientation`: an error of 3 degrees and 5 cm; planning by what is seen from sampled poses against planning as if
/// there were no error, on mug and SGI logo.
[[nodiscard]] Experiment orientation_experiment(const ExperimentOptions& options);
/// `learning`: errors of 10 and 20 cm that the planner does not know, learned from the registered scans, against
/// planners that know it and that plan as if there were none.
[[nodiscard]] Experiment learning_experiment(const ExperimentOptions& options);
/// `registration`: what ICP makes of the scans with and without overlap in the utility, with and without convolution.
[[nodiscard]] Experiment registration_experiment(const ExperimentOptions& options);

/// `robustness`: whole runs of a robot that misses with ICP, true and believed poses: how many see all, how many scans
/// are refused and recovered, how far merged scans are off.
[[nodiscard]] Experiment robustness_experiment(const ExperimentOptions& options);

}  // namespace vantage
