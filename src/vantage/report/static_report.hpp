#pragma once

#include <string>

#include "vantage/report/report_data.hpp"

namespace vantage {

/// The sections of a report as one <article class="report">, with their style: pictures of the model, the views around
/// it, curves over the scans, the chosen views with factors and reasons, slices through the labels, times. Needs no
/// script and no other file. A run without scans, or without a map, gives the sections that remain.
[[nodiscard]] std::string static_report_body(const ReportData& data);

/// The same as a whole page.
[[nodiscard]] std::string static_report_html(const ReportData& data);

/// report.html of a run: the interactive page, with the static sections for readers without JavaScript, and alone where
/// the program was built without that page. `run.static_html` is replaced.
[[nodiscard]] std::string report_page(RunData run, const VoxelMap& map, std::optional<double> seconds = std::nullopt);

/// What the run came to in one sentence: views, coverage, distance and why it stopped.
[[nodiscard]] std::string report_summary(const ReportData& data);

}  // namespace vantage
