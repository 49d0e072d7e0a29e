#pragma once

#include "vantage/experiments/experiments.hpp"

namespace vantage {

/// Table 1 (exhaustive) or 2 (multi-resolution): views, occupied voxels, quality and distance of every object.
[[nodiscard]] ExperimentTable search_table(const std::string& search, const ExperimentOptions& options,
                                           const RunProgress& progress);
/// Table 4: with and without the navigation factor, multi-resolution, paired by initial view.
[[nodiscard]] ExperimentTable navigation_table(const ExperimentOptions& options, const RunProgress& progress);
/// Figure 9: the combined utility against the greatest unknown area on the mug, ratios of the means over 20 starts.
[[nodiscard]] ExperimentFigure gua_figure(const ExperimentOptions& options, const RunProgress& progress);
/// Figures 10 and 11: coverage after each scan without error, with it, and with convolution after evaluation.
[[nodiscard]] std::vector<ExperimentReport::Part> positioning_error_figure(const std::string& name,
                                                                           const std::vector<std::string>& objects,
                                                                           const ExperimentOptions& options,
                                                                           const RunProgress& progress);

}  // namespace vantage
