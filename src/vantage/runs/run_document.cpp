#include "vantage/runs/run_document.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/files/packed_array.hpp"
#include "vantage/runs/document_geometry.hpp"
#include "vantage/runs/run_files.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t max_cloud_points = 150000;
constexpr std::size_t max_triangles = 60000;

template <class T>
Json json_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// One number of every evaluated candidate; NaN for the others.
template <class Get>
Json floats_json(const std::vector<Evaluation>& evaluations, Get get) {
  std::vector<float> values;
  values.reserve(evaluations.size());
  for (const Evaluation& e : evaluations) {
    values.push_back(e.evaluated() ? static_cast<float>(get(e)) : std::numeric_limits<float>::quiet_NaN());
  }
  return packed_array<float>(values);
}

template <class Get>
Json counts_json(const std::vector<Evaluation>& evaluations, Get get) {
  std::vector<std::uint32_t> values;
  values.reserve(evaluations.size());
  for (const Evaluation& e : evaluations) values.push_back(static_cast<std::uint32_t>(get(e)));
  return packed_array<std::uint32_t>(values);
}

std::string_view state_name(RunData::State state) {
  switch (state) {
    case RunData::State::running:
      return "running";
    case RunData::State::waiting:
      return "waiting";
    case RunData::State::finished:
      break;
  }
  return "finished";
}

Json meta_json(const RunData& run) {
  Json options = Json::object();
  for (const auto& [name, value] : run.options) options[name] = value;
  return {{"command", run.command},        {"object", run.object},           {"program", run.program},
          {"options", std::move(options)}, {"seed", json_or_null(run.seed)}, {"state", state_name(run.state)},
          {"simulated", run.simulated}};
}

Json grid_json(const RunData& run) {
  const auto& [min, max] = run.enclosure;
  return {{"origin", point_json(run.grid.min)},
          {"voxel", run.grid.length},
          {"size", {run.grid.size.x(), run.grid.size.y(), run.grid.size.z()}},
          {"enclosure", {min.x(), min.y(), min.z(), max.x(), max.y(), max.z()}}};
}

Json camera_json(const RangeCamera& camera) {
  return {{"columns", camera.resolution.columns},
          {"rows", camera.resolution.rows},
          {"left", camera.left},
          {"right", camera.right},
          {"top", camera.top},
          {"bottom", camera.bottom},
          {"min_depth", camera.min_depth},
          {"max_depth", camera.max_depth}};
}

Json candidates_json(const RunData& run) {
  std::vector<float> poses;
  for (const View& view : run.candidates.views) {
    for (const double number : pose_numbers(view.world_from_sensor)) poses.push_back(static_cast<float>(number));
  }
  Json json{{"kind", run.candidates.kind == Candidates::Kind::sphere ? "sphere" : "list"},
            {"text", run.candidates_text},
            {"center", point_json(run.candidates.center)},
            {"poses", packed_array<float>(poses, 7)}};
  if (run.candidates.grid) {
    std::vector<std::uint16_t> cells;
    for (const Index3& cell : run.candidates.grid->cell_of_view) {
      for (int axis = 0; axis < 3; ++axis) cells.push_back(static_cast<std::uint16_t>(cell[axis]));
    }
    json["kind"] = "grid";
    json["cells_per_side"] = run.candidates.grid->cells_per_side;
    json["spacing"] = point_json(run.candidates.grid->spacing);
    json["cells"] = packed_array<std::uint16_t>(cells, 3);
  }
  return json;
}

Json summary_json(const RunData& run) {
  if (run.scans.empty()) return nullptr;
  const ScanRecord& last = run.scans.back().record;
  return {{"views", run.scans.size()},
          {"occupied", last.labels.occupied},
          {"mean_quality", last.mean_quality},
          {"distance", last.distance},
          {"coverage", json_or_null(last.coverage)},
          {"coverage_all", json_or_null(last.coverage_all)}};
}

}  // namespace

Json plan_json(const CandidatePlan& plan) {
  const auto& all = plan.evaluations;
  std::vector<std::string> reasons;
  std::vector<std::uint8_t> infeasible;
  for (const Evaluation& e : all) {
    if (e.feasible) {
      infeasible.push_back(0);
      continue;
    }
    auto place = std::find(reasons.begin(), reasons.end(), e.reason) - reasons.begin();
    if (place == static_cast<std::ptrdiff_t>(reasons.size())) {
      if (reasons.size() < 254)
        reasons.push_back(e.reason);
      else
        place = 253;  // one byte per candidate: so many different reasons are not read by anybody
    }
    infeasible.push_back(static_cast<std::uint8_t>(1 + place));
  }
  const auto score = [](const Evaluation& e) { return e.score; };
  return {{"chosen", json_or_null(plan.chosen)},
          {"utility", floats_json(all, [](const Evaluation& e) { return e.utility; })},
          {"convolved", plan.convolved ? floats_json(all, score) : Json(nullptr)},
          {"n_oc", counts_json(all, [](const Evaluation& e) { return e.seen.occupied; })},
          {"n_op", counts_json(all, [](const Evaluation& e) { return e.seen.occplane; })},
          {"n_um", counts_json(all, [](const Evaluation& e) { return e.seen.unmarked; })},
          {"f_area", floats_json(all, [](const Evaluation& e) { return e.factors.f_area; })},
          {"f_navigation", floats_json(all, [](const Evaluation& e) { return e.factors.f_navigation; })},
          {"f_quality", floats_json(all, [](const Evaluation& e) { return e.factors.f_quality; })},
          {"f_occlusion", floats_json(all, [](const Evaluation& e) { return e.factors.f_occlusion; })},
          {"infeasible", packed_array<std::uint8_t>(infeasible)},
          {"reasons", reasons}};
}

Json scan_json(const RecordedScan& scan) {
  const ScanRecord& r = scan.record;
  Json json = scan_json(r);
  if (!r.merged) json["registered"] = nullptr;
  json["plan"] = scan.plan ? plan_json(*scan.plan) : Json(nullptr);
  json["labels"] = packed_array<std::uint8_t>(scan.change.labels);
  json["surface"] = {{"voxels", packed_array<std::uint32_t>(scan.change.voxels, 1, PackedRows::differences)},
                     {"normals", packed_array<std::int8_t>(scan.change.normals, 3)},
                     {"quality", packed_array<std::uint8_t>(scan.change.quality)}};
  json["milliseconds"] = {{"plan", 1e3 * r.timings.plan},
                          {"scan", 1e3 * r.timings.scan},
                          {"register", 1e3 * r.timings.registration},
                          {"integrate", 1e3 * r.timings.integration}};
  return json;
}

Json result_json(const RunData& run) {
  return {{"cloud", cloud_json(run.cloud, run.scan_of_point, max_cloud_points)},
          {"mesh", mesh_json(run.mesh, max_triangles)}};
}

Json state_json(const RunData& run) {
  return {{"state", state_name(run.state)}, {"stop_reason", run.stop_reason}, {"summary", summary_json(run)}};
}

Json setup_json(const RunData& run) {
  return {{"camera", camera_json(run.camera)}, {"candidates", candidates_json(run)}};
}

Json run_json(const RunData& run) {
  Json scans = Json::array();
  for (const RecordedScan& scan : run.scans) scans.push_back(scan_json(scan));
  return {{"format", "vantage-run"},
          {"version", 1},
          {"meta", meta_json(run)},
          {"grid", grid_json(run)},
          {"camera", camera_json(run.camera)},
          {"candidates", candidates_json(run)},
          {"scans", std::move(scans)},
          {"next", run.next ? plan_json(*run.next) : Json(nullptr)},
          {"stop_reason", run.stop_reason},
          {"summary", summary_json(run)},
          {"cloud", cloud_json(run.cloud, run.scan_of_point, max_cloud_points)},
          {"mesh", mesh_json(run.mesh, max_triangles)},
          {"truth", mesh_json(run.truth, max_triangles)}};
}

}  // namespace vantage
