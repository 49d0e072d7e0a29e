#include "vantage/experiments/compare_options.hpp"

#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/utility/registry.hpp"

namespace vantage {
namespace {

const std::vector<std::string> knowing{"known-greedy", "known-optimum"};

std::vector<std::string> at_commas(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

std::vector<std::string> CompareOptions::methods() const {
  std::vector<std::string> names{baseline};
  std::vector<std::string> wanted = at_commas(utilities);
  if (utilities == "all") {
    wanted = utility_names();
    wanted.insert(wanted.end(), knowing.begin(), knowing.end());
  }
  if (external) wanted.emplace_back("external");
  for (const std::string& name : wanted) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

void CompareOptions::validate() const {
  for (const std::string& name : methods()) {
    const bool is_special =
        name == "external" ? external.has_value() : std::find(knowing.begin(), knowing.end(), name) != knowing.end();
    if (is_special) continue;
    try {
      (void)utility_by_name(name);
    } catch (const InputError& error) {
      throw InputError(concat("utilities: ", error.what(), ", known-greedy, known-optimum"));
    }
  }
  (void)protocol_by_name(protocol);
  require(external_timeout > 0 && std::isfinite(external_timeout), "external-timeout = ", external_timeout,
          " s: must be positive");
  require(budget() >= 2 && budget() <= 200, "compare-max-views = ", budget(), ": must be in 2..200");
  time.validate();
  run_options().validate();
}

ReconstructOptions CompareOptions::run_options() const {
  ReconstructOptions options;
  options.depth_noise = {depth_noise.x(), depth_noise.y()};
  options.positioning_error = positioning_error;
  options.registration = registration;
  options.max_views = budget();
  options.scan_time = time.scan;
  options.speed = time.speed;
  protocol_by_name(protocol).set(options);
  return options;
}

int CompareOptions::budget() const { return max_views.value_or(protocol_by_name(protocol).max_views); }

}  // namespace vantage
