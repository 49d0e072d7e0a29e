#include "vantage/runs/stored_run_files.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/files/format_version.hpp"
#include "vantage/files/json_text.hpp"
#include "vantage/files/yaml_text.hpp"
#include "vantage/options/options.hpp"
#include "vantage/registration/registration.hpp"
#include "vantage/runs/run_files.hpp"

namespace vantage {
namespace {

View view_from_json(const nlohmann::json& pose, const std::string& what) {
  require(pose.is_array() && pose.size() == 7, what, ": must be 7 numbers x y z qx qy qz qw");
  std::array<double, 7> n{};
  for (std::size_t i = 0; i < n.size(); ++i) n[i] = json_number(pose[i], what);
  const Eigen::Quaterniond rotation(n[6], n[3], n[4], n[5]);
  require(std::abs(rotation.norm() - 1) < 1e-3, what, ": the quaternion has length ", rotation.norm(), ", must be 1");
  View view;
  view.world_from_sensor.linear() = rotation.normalized().toRotationMatrix();
  view.world_from_sensor.translation() = Vec3(n[0], n[1], n[2]);
  return view;
}

int candidate_from_json(const nlohmann::json& candidate, const std::string& what) {
  const double value = json_number(candidate, what);
  require(value >= -1 && value <= std::numeric_limits<int>::max(), what, " = ", value, ": must be the index of a view");
  return static_cast<int>(value);
}

bool says_that_it_failed(const std::string& verdict) {
  constexpr std::array failures{Verdict::insufficient_overlap, Verdict::not_converged, Verdict::large_residual,
                                Verdict::degenerate,           Verdict::in_free_space, Verdict::ambiguous};
  return std::any_of(failures.begin(), failures.end(), [&](Verdict failure) { return verdict == name(failure); });
}

std::optional<std::string> text_of(const YAML::Node& config, const char* key, const std::string& name) {
  const YAML::Node node = config[key];
  if (!node.IsDefined()) return std::nullopt;
  require(node.IsScalar(), place_of(node, name), ": ", key, ": must be a text");
  return node.Scalar();
}

}  // namespace

StoredSummary parse_run_summary(std::string_view bytes, const std::string& name) {
  const nlohmann::json summary = parse_json(bytes, name);
  require(summary.is_object(), name, ": must be an object, is ", summary.type_name());
  const nlohmann::json format = summary.value("format", nlohmann::json(summary_format));
  require_known_format(json_number(format, name + ", format"), summary_format, name);
  StoredSummary result;
  if (summary.contains("object")) {
    const nlohmann::json& object = summary["object"];
    require(object.is_string(), name, ", object: must be text, is ", object.type_name());
    result.object = object.get<std::string>();
  }
  const nlohmann::json scans = summary.value("scans", nlohmann::json::array());
  require(scans.is_array(), name, ", scans: must be a list, is ", scans.type_name());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::string what = concat(name, ", scans[", i, "]");
    require(scans[i].is_object(), what, ": must be an object, is ", scans[i].type_name());
    ScanRecord scan;
    scan.scan = static_cast<int>(i);
    const nlohmann::json candidate = scans[i].value("candidate", nlohmann::json());
    if (candidate.is_number_integer()) scan.candidate = candidate_from_json(candidate, what + ".candidate");
    for (const auto& [key, view] :
         {std::pair{"commanded", &scan.commanded}, {"believed", &scan.believed}, {"registered", &scan.registered}})
      *view = view_from_json(scans[i].value(key, nlohmann::json()), concat(what, ".", key));
    const nlohmann::json verdict = scans[i].value("verdict", nlohmann::json());
    if (verdict.is_string()) scan.verdict = verdict.get<std::string>();
    const nlohmann::json merged = scans[i].value("merged", nlohmann::json());
    require(merged.is_null() || merged.is_boolean(), what, ".merged: must be true or false");
    // Summaries of earlier versions have only the word.
    scan.merged = merged.is_boolean() ? merged.get<bool>() : !says_that_it_failed(scan.verdict);
    if (scans[i].contains("residual") && !scans[i]["residual"].is_null())
      scan.residual = json_number(scans[i]["residual"], what + ".residual");
    result.scans.push_back(scan);
  }
  return result;
}

StoredConfig parse_run_config(std::string_view bytes, const std::string& name) {
  require_known_configuration(bytes, name);
  const YAML::Node config = parse_yaml(bytes, name);
  if (config.IsNull()) return {};
  require(config.IsMap(), name, ": must be a list of lines 'option: value'");
  StoredConfig result;
  result.candidates = text_of(config, "candidates", name);
  result.camera = text_of(config, "camera", name);
  return result;
}

}  // namespace vantage
