#pragma once

#include <string>
#include <vector>

#include "vantage/experiments/run_outcome.hpp"
#include "vantage/options/reconstruct_options.hpp"
#include "vantage/report/svg_plot.hpp"

// What the experiments with a robot that misses share.
namespace vantage {

/// Section 9 of the paper: a camera with wide apertures, the view cube, no navigation factor.
[[nodiscard]] ReconstructOptions free_flyer();

/// Scans whose mean coverage tells methods apart: before them all is the same, after them all is done.
inline constexpr std::size_t first_compared_scan = 2, last_compared_scan = 10;

/// Mean coverage over these scans, per cent.
[[nodiscard]] double mean_coverage(const RunOutcome& outcome);
/// Scans until the coverage (a share) is reached; one more than there are where it is not.
[[nodiscard]] double views_to(double coverage, const RunOutcome& outcome);

/// The mean of a list over the runs for each of the scans 1 .. `scans`, with its 95 % interval as band.
[[nodiscard]] LineSeries curve_over_scans(const std::string& name, const std::vector<RunOutcome>& outcomes,
                                          const std::string& list, double unit, std::size_t scans);

}  // namespace vantage
