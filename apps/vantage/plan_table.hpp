#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "vantage/reconstruction/reconstruction.hpp"

namespace vantage::app {

/// A view's evaluation under the keys of `evaluate --json` (spec, section 11).
[[nodiscard]] nlohmann::ordered_json view_json(const Evaluation& evaluation);

/// The `top` best views as a table with their factors, then the candidates that fell out with the reason.
void print_views(std::vector<Evaluation> evaluations, int top);

/// The next best view with its reason and the views ranked after it, or why there is none.
void print_plan(const std::optional<Plan>& plan, const std::string& why_finished, int top);
[[nodiscard]] nlohmann::ordered_json plan_json(const std::optional<Plan>& plan, const std::string& why_finished,
                                               const ObjectModel& model, int top);

}  // namespace vantage::app
