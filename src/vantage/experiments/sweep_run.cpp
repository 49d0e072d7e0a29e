#include "vantage/experiments/sweep_run.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "vantage/options/options.hpp"

namespace vantage {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// Of the voxels that a scan puts points into, the share that the map held before.
double overlap_with_before(const ScanRecord& record, const Scan& scan, const VoxelMap& map) {
  const PointCloud points = points_of(scan);
  const IndexBox& enclosure = map.enclosure();
  const Index3 size = enclosure.size();
  std::vector<char> touched(static_cast<std::size_t>(size.cast<std::int64_t>().prod()));
  for (const Vec3& point : points.points) {
    const Index3 index = map.grid().index_of(record.registered.world_from_sensor * point);
    if (!enclosure.contains(index)) continue;
    const Index3 local = index - enclosure.min;
    touched[static_cast<std::size_t>((local.z() * size.y() + local.y()) * size.x() + local.x())] = 1;
  }
  const auto voxels = std::count(touched.begin(), touched.end(), 1);
  return voxels == 0 ? 0 : 1 - static_cast<double>(record.new_occupied) / static_cast<double>(voxels);
}

void add_scan(RunOutcome& outcome, const ScanRecord& record, const Scan& scan, const ObjectModel& model) {
  const auto add = [&outcome](const char* name, double value) { outcome.lists[name].push_back(value); };
  add("coverage", record.coverage.value_or(not_known));
  add("coverage_all", record.coverage_all.value_or(not_known));
  add("occupied", static_cast<double>(record.labels.occupied));
  add("new_occupied", static_cast<double>(record.new_occupied));
  add("quality", record.mean_quality);
  add("distance", record.distance);
  add("candidate", record.candidate);
  add("n_oc", record.planned ? static_cast<double>(record.planned->seen.occupied) : not_known);
  add("n_op", record.planned ? static_cast<double>(record.planned->seen.occplane) : not_known);
  add("n_um", record.planned ? static_cast<double>(record.planned->seen.unmarked) : not_known);
  add("utility", record.planned ? record.planned->utility : not_known);
  add("overlap", record.merged ? overlap_with_before(record, scan, model.map) : not_known);
  add("registration_overlap", record.overlap);
  add("residual", record.residual);
  outcome.times["plan"].push_back(1000 * record.timings.plan);
  outcome.times["registration"].push_back(1000 * record.timings.registration);
  outcome.times["integration"].push_back(1000 * record.timings.integration);
}

/// What is known of a scan when the run has ended: it may have been merged later than it was taken.
void add_final(RunOutcome& outcome, const ScanRecord& record) {
  const auto add = [&outcome](const char* name, double value) { outcome.lists[name].push_back(value); };
  add("merged", record.merged ? 1 : 0);
  add("merged_at_once", record.merged_after == record.scan ? 1 : 0);
  add("register_probability",
      record.planned && record.planned->registrability ? record.planned->registrability->probability : not_known);
  add("expected_misplacement",
      record.planned && record.planned->registrability ? record.planned->registrability->misplacement : not_known);
  const View& truth = record.true_view.value_or(record.registered);
  add("position_error", (record.registered.position() - truth.position()).norm());
  add("orientation_error",
      rotation_angle(record.registered.world_from_sensor.linear(), truth.world_from_sensor.linear()));
  add("pose_error", record.pose_error.value_or(not_known));
}

void add_totals(RunOutcome& outcome, const SimulatedRun& run) {
  const std::vector<ScanRecord>& scans = run.model.scans;
  const ScanRecord& last = scans.back();
  for (const ScanRecord& record : scans) add_final(outcome, record);
  const auto count = [&scans](const auto& is_counted) {
    return static_cast<double>(std::count_if(scans.begin(), scans.end(), is_counted));
  };
  outcome.numbers["views"] = static_cast<double>(scans.size());
  outcome.numbers["failed_scans"] = count([](const ScanRecord& scan) { return !scan.merged; });
  outcome.numbers["refused_scans"] = count([](const ScanRecord& scan) { return scan.merged_after != scan.scan; });
  outcome.numbers["recovered_scans"] =
      count([](const ScanRecord& scan) { return scan.merged_after && *scan.merged_after > scan.scan; });
  outcome.numbers["occupied"] = static_cast<double>(last.labels.occupied);
  outcome.numbers["quality"] = last.mean_quality;
  outcome.numbers["distance"] = last.distance;
  outcome.numbers["coverage"] = last.coverage.value_or(not_known);
  outcome.numbers["coverage_all"] = last.coverage_all.value_or(not_known);
  outcome.texts["stop_reason"] = run.stop_reason;
}

}  // namespace

SweepRun reconstruction_run(const std::string& name, std::shared_ptr<const SweepObject> object,
                            const ReconstructOptions& options, const ExtraMeasures& extra) {
  options.validate();
  nlohmann::ordered_json configuration{{"kind", "reconstruction"},
                                       {"object", object->name()},
                                       {"mesh", object->digest()},
                                       {"object-size", object->size()}};
  if (!extra.name.empty()) configuration["measures"] = extra.name;
  ReconstructOptions described = options;
  nlohmann::ordered_json values;
  for (const OptionField& field : option_fields(described)) values[field.name] = field.text();
  configuration["options"] = values;

  return {name, configuration.dump(),
          [object, options, extra](const Interrupted& interrupted) {
            const std::shared_ptr<const SimulatedObject> simulated = object->simulated(options);
            RunOutcome outcome;
            RunObserver observer;
            const ExtraMeasures::OnScan more = extra.per_scan ? extra.per_scan(*object, options) : nullptr;
            observer.interrupted = interrupted;
            observer.on_scan = [&](const ScanRecord& record, const Scan& scan, const ObjectModel& model, const Plan*) {
              add_scan(outcome, record, scan, model);
              if (more) more(record, scan, outcome);
            };
            std::optional<Utility> utility;
            if (extra.utility) utility = extra.utility(*simulated, options);
            const SimulatedRun run = simulate(*simulated, options, observer, utility);
            if (run.stop_reason == "interrupted") throw RunInterrupted();
            add_totals(outcome, run);
            if (extra.add) extra.add(run, *simulated, outcome);
            return outcome;
          },
          SweepRun::Place::anywhere};
}

}  // namespace vantage
