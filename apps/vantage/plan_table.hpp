#pragma once

#include <cstdio>
#include <optional>
#include <string>

#include "vantage/model/scan_record.hpp"
#include "vantage/planning/planner.hpp"

namespace vantage::app {

/// The `top` best views as a table with their factors, then the candidates that fell out with the reason.
void print_views(std::vector<Evaluation> evaluations, int top);

/// One line on how a real scan was registered and what it brought.
void print_record(std::FILE* out, const ScanRecord& record);

/// The corner places of a move; joints in radians and metres.
void print_move(const Move& move);

/// The next best view with its reason and the views ranked after it, or why there is none.
void print_plan(const std::optional<Plan>& plan, const std::string& why_finished, int top);

}  // namespace vantage::app
