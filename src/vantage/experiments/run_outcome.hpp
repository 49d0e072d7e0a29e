#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace vantage {

/// What is kept of one run of a sweep: numbers by name, and lists by name with one entry per scan. New measures are new
/// names. Everything but `times` is the same bits whenever the same run is repeated. docs/experiments.md lists the
/// names that a reconstruction has.
struct RunOutcome {
  std::map<std::string, double> numbers;
  std::map<std::string, std::vector<double>> lists;
  std::map<std::string, std::string> texts;
  std::map<std::string, std::vector<double>> times;  // milliseconds; stored apart from the rest

  /// Each throws InputError that names what is missing.
  [[nodiscard]] double number(const std::string& name) const;
  [[nodiscard]] const std::vector<double>& list(const std::string& name) const;
  [[nodiscard]] const std::vector<double>& time(const std::string& name) const;
};

/// Everything but the times. NaN becomes null and back.
[[nodiscard]] nlohmann::ordered_json outcome_json(const RunOutcome& outcome);
[[nodiscard]] nlohmann::ordered_json times_json(const RunOutcome& outcome);
/// The reverse; `name` (a file) is for errors: InputError where a part is missing or of the wrong kind.
[[nodiscard]] RunOutcome outcome_from_json(const nlohmann::json& outcome, const nlohmann::json& times,
                                           const std::string& name);

/// One number of each outcome.
[[nodiscard]] std::vector<double> numbers(const std::vector<RunOutcome>& outcomes, const std::string& name);
/// A list's value after scan `scan` (from 1); after the last scan its value is carried forward.
[[nodiscard]] double after_scan(const RunOutcome& outcome, const std::string& name, std::size_t scan);
/// What `measure` makes of each outcome.
template <class Measure>
[[nodiscard]] std::vector<double> each(const std::vector<RunOutcome>& outcomes, const Measure& measure) {
  std::vector<double> values;
  values.reserve(outcomes.size());
  for (const RunOutcome& outcome : outcomes) values.push_back(measure(outcome));
  return values;
}

}  // namespace vantage
