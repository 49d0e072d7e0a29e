#pragma once

#include "vantage/experiments/experiments.hpp"

namespace vantage {

/// Tables 1 and 2: views, occupied voxels, quality and distance of every object, with the exhaustive and the
/// multi-resolution search.
[[nodiscard]] Experiment exhaustive_table(const ExperimentOptions& options);
[[nodiscard]] Experiment multi_resolution_table(const ExperimentOptions& options);
/// Table 3: the time of one plan by resolution of the map and number of views, both searches. Not deterministic.
[[nodiscard]] Experiment times_table(const ExperimentOptions& options);
/// Table 4: with and without the navigation factor, multi-resolution, paired by initial view.
[[nodiscard]] Experiment navigation_table(const ExperimentOptions& options);
/// Figure 7: the utility of views of the cube before and after convolution, as surfaces.
[[nodiscard]] Experiment utility_surface_figure(const ExperimentOptions& options);
/// Figure 9: the combined utility against the greatest unknown area on the mug, ratios of the means over 20 starts.
[[nodiscard]] Experiment gua_figure(const ExperimentOptions& options);
/// The same ratios on other meshes, objects, initial views and readings of the paper: what could explain a difference.
[[nodiscard]] Experiment gua_readings_table(const ExperimentOptions& options);
/// Figures 10 (sphere and mug) and 11 (SGI logo): coverage after each scan without error, with it, and with convolution
/// after evaluation.
[[nodiscard]] Experiment simple_objects_figure(const ExperimentOptions& options);
[[nodiscard]] Experiment logo_figure(const ExperimentOptions& options);
/// Figure 11 with other rays, errors and sensors: what the gain of convolution depends on.
[[nodiscard]] Experiment convolution_readings_table(const ExperimentOptions& options);

}  // namespace vantage
