#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/model/scan_record.hpp"
#include "vantage/planning/planner.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage::app {

/// How much of a ranking is printed.
struct PlanTableOptions {
  int top = 10;          // views in the table, best first
  bool verbose = false;  // a line for each infeasible view, instead of their numbers by reason
};

/// The best views as a table with their factors, then the infeasible ones summed up by reason.
void print_views(std::vector<Evaluation> evaluations, const PlanTableOptions& options);

/// How many of the views are infeasible for each kind of reason, most frequent first: "42 of 80: outside the
/// workspace". Reasons that differ only in their numbers are one kind, whose numbers are printed as "…".
[[nodiscard]] std::vector<std::string> infeasible_by_reason(const std::vector<Evaluation>& evaluations);

/// What was recognised in a set of scans, and what was left out of it, a line each, on standard error.
void print_scan_set(const ScanSet& set);

/// One line, with its end, on how a real scan was registered and what it brought.
[[nodiscard]] std::string record_line(const ScanRecord& record);

/// The corner places of a move; joints in radians and metres.
void print_move(const Move& move);
/// The rest of the scan, view by view; nothing where none is planned.
void print_tour(const std::vector<TourStop>& tour);

/// The next best view with its reason and the views ranked after it, or why there is none.
void print_plan(const std::optional<Plan>& plan, const std::string& why_finished, const PlanTableOptions& options);

}  // namespace vantage::app
