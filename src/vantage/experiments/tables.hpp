#pragma once

#include "vantage/experiments/experiments.hpp"

namespace vantage {

/// Tables 1 and 2: views, occupied voxels, quality and distance of every object, with the exhaustive and the
/// multi-resolution search.
[[nodiscard]] Experiment exhaustive_table(const ExperimentOptions& options);
[[nodiscard]] Experiment multi_resolution_table(const ExperimentOptions& options);
/// Table 4: with and without the navigation factor, multi-resolution, paired by initial view.
[[nodiscard]] Experiment navigation_table(const ExperimentOptions& options);
/// Figure 9: the combined utility against the greatest unknown area on the mug, ratios of the means over 20 starts.
[[nodiscard]] Experiment gua_figure(const ExperimentOptions& options);
/// Figures 10 (sphere and mug) and 11 (SGI logo): coverage after each scan without error, with it, and with convolution
/// after evaluation.
[[nodiscard]] Experiment simple_objects_figure(const ExperimentOptions& options);
[[nodiscard]] Experiment logo_figure(const ExperimentOptions& options);

}  // namespace vantage
