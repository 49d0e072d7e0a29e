#include "vantage/runs/run_files.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Text as a CSV field: quoted, quotes doubled.
std::string quoted(const std::string& text) {
  std::string result;
  for (const char c : text) result.append(c == '"' ? 2 : 1, c);
  return fmt::format("\"{}\"", result);
}

std::string csv_field(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return quoted(value.get<std::string>());
  return value.dump();
}

}  // namespace

Json pose_error_json(const PoseError& error) {
  PoseError::Vector unit;
  unit << Vec3::Ones(), Vec3::Constant(degrees(1));
  Json json{{"mean", Json::array()}, {"covariance", Json::array()}};
  for (int i = 0; i < 6; ++i) {
    json["mean"].push_back(error.mean[i] * unit[i]);
    Json row = Json::array();
    for (int k = 0; k < 6; ++k) row.push_back(error.covariance(i, k) * unit[i] * unit[k]);
    json["covariance"].push_back(row);
  }
  return json;
}

Json mesh_quality_json(const MeshQuality& quality) {
  return {{"triangles", quality.triangles},
          {"seen_area", quality.seen_area},
          {"cap_area", quality.cap_area},
          {"cap_share", quality.cap_share()},
          {"volume", or_null(quality.volume)},
          {"sigma_median", quality.median_sigma},
          {"sigma_95", quality.percentile_95_sigma},
          {"target_accuracy", or_null(quality.wanted_sigma)},
          {"accurate_area", or_null(quality.accurate_area)}};
}

std::array<double, 7> pose_numbers(const Pose& pose) {
  Eigen::Quaterniond q(pose.linear());
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Vec3 p = pose.translation();
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}

Json scan_json(const ScanRecord& record) {
  Json json;
  json["scan"] = record.scan;
  json["candidate"] = record.candidate >= 0 ? Json(record.candidate) : Json(nullptr);
  json["commanded"] = pose_numbers(record.commanded.world_from_sensor);
  json["believed"] = pose_numbers(record.believed.world_from_sensor);
  json["registered"] = pose_numbers(record.registered.world_from_sensor);
  const auto planned = [&record](const auto& value) {
    return record.planned ? Json(value(*record.planned)) : Json(nullptr);
  };
  json["n_oc"] = planned([](const Evaluation& e) { return e.seen.occupied; });
  json["n_op"] = planned([](const Evaluation& e) { return e.seen.occplane; });
  json["n_um"] = planned([](const Evaluation& e) { return e.seen.unmarked; });
  json["f_area"] = planned([](const Evaluation& e) { return e.factors.f_area; });
  json["f_navigation"] = planned([](const Evaluation& e) { return e.factors.f_navigation; });
  json["f_quality"] = planned([](const Evaluation& e) { return e.factors.f_quality; });
  json["f_occlusion"] = planned([](const Evaluation& e) { return e.factors.f_occlusion; });
  json["utility"] = planned([](const Evaluation& e) { return e.utility; });
  json["occupied"] = record.labels.occupied;
  json["occplane"] = record.labels.occplane;
  json["unmarked"] = record.labels.unmarked;
  json["new_occupied"] = record.new_occupied;
  json["mean_quality"] = record.mean_quality;
  json["distance"] = record.distance;
  json["coverage"] = or_null(record.coverage);
  json["coverage_all"] = or_null(record.coverage_all);
  json["overlap"] = record.overlap;
  json["residual"] = record.residual;
  json["verdict"] = record.verdict;
  json["reason"] = record.reason;
  const auto expected = [&record](const auto& value) {
    return record.planned && record.planned->expected ? Json(value(*record.planned->expected)) : Json(nullptr);
  };
  json["expected_utility"] = expected([](const Expectation& e) { return e.utility; });
  json["overlap_probability"] = expected([](const Expectation& e) { return e.registers; });
  const auto learned = [&record](int first, double unit) {
    if (!record.learned_error) return Json(nullptr);
    return Json(std::sqrt(record.learned_error->covariance.diagonal().segment<3>(first).mean()) / unit);
  };
  json["learned_sigma"] = learned(0, 1);
  json["learned_angle"] = learned(3, radians(1));
  json["merged"] = record.merged;
  json["merged_after"] = or_null(record.merged_after);
  json["true_pose"] = record.true_view ? Json(pose_numbers(record.true_view->world_from_sensor)) : Json(nullptr);
  json["pose_error"] = or_null(record.pose_error);
  const auto foreseen = [&record](const auto& value) {
    return record.planned && record.planned->registrability ? Json(value(*record.planned->registrability))
                                                            : Json(nullptr);
  };
  json["register_probability"] = foreseen([](const Registrability& r) { return r.probability; });
  json["expected_misplacement"] = foreseen([](const Registrability& r) { return r.misplacement; });
  json["flying_pixels"] = record.flying;
  json["taken_back"] = record.taken_back;
  return json;
}

Json sensor_json(const SensorModel& sensor) {
  return {{"constant", sensor.constant},   {"linear", sensor.linear},
          {"quadratic", sensor.quadratic}, {"incidence", sensor.incidence},
          {"quantum", sensor.quantum},     {"disparity_quantum", sensor.disparity_quantum}};
}

Json summary_json(const ObjectModel& model, const RunSummary& summary) {
  Json json;
  json["format"] = summary_format;
  json["object"] = summary.object;
  json["views"] = model.scans.size();
  json["occupied"] = model.map.count(Label::occupied);
  json["mean_quality"] = model.map.mean_quality();
  json["distance"] = model.scans.empty() ? 0 : model.scans.back().distance;
  const auto last = [&model](const auto& member) {
    return model.scans.empty() ? Json(nullptr) : or_null(model.scans.back().*member);
  };
  json["coverage"] = last(&ScanRecord::coverage);
  json["coverage_all"] = last(&ScanRecord::coverage_all);
  json["accuracy_rms"] = or_null(summary.accuracy_rms);
  json["accuracy_95"] = or_null(summary.accuracy_95);
  json["completeness"] = or_null(summary.completeness);
  json["completeness_all"] = or_null(summary.completeness_all);
  json["stop_reason"] = summary.stop_reason;
  json["seed"] = summary.seed;
  json["sensor"] = sensor_json(model.sensor);
  json["learned_error"] = model.scans.empty() || !model.scans.back().learned_error
                              ? Json(nullptr)
                              : pose_error_json(*model.scans.back().learned_error);
  json["mesh"] = summary.mesh ? mesh_quality_json(*summary.mesh) : Json(nullptr);
  json["scans"] = Json::array();
  for (const ScanRecord& record : model.scans) json["scans"].push_back(scan_json(record));
  return json;
}

std::string views_csv(const std::vector<ScanRecord>& scans) {
  constexpr std::array<const char*, 7> parts{"x", "y", "z", "qx", "qy", "qz", "qw"};
  std::string header;
  std::string rows;
  ScanRecord with_all_poses;
  with_all_poses.true_view.emplace();
  const Json names = scan_json(with_all_poses);
  for (const auto& [key, value] : names.items()) {
    if (!header.empty()) header += ',';
    if (!value.is_array()) {
      header += key;
      continue;
    }
    for (std::size_t i = 0; i < parts.size(); ++i) header += fmt::format("{}{}_{}", i == 0 ? "" : ",", key, parts[i]);
  }
  for (const ScanRecord& record : scans) {
    std::string row;
    const Json values = scan_json(record);
    for (const auto& [key, value] : values.items()) {
      if (!names[key].is_array()) {
        row += fmt::format("{}{}", row.empty() ? "" : ",", csv_field(value));
        continue;
      }
      for (std::size_t i = 0; i < parts.size(); ++i)
        row += fmt::format(",{}", csv_field(value.is_null() ? Json(nullptr) : value[i]));
    }
    rows += row + '\n';
  }
  return header + '\n' + rows;
}

Json timings_json(const std::vector<ScanRecord>& scans, double total_seconds) {
  Json json;
  json["total"] = total_seconds;
  json["scans"] = Json::array();
  for (const ScanRecord& record : scans) {
    const ScanTimings& t = record.timings;
    json["scans"].push_back(Json{{"scan", record.scan},
                                 {"plan", t.plan},
                                 {"take", t.scan},
                                 {"registration", t.registration},
                                 {"integration", t.integration}});
  }
  return json;
}

}  // namespace vantage
