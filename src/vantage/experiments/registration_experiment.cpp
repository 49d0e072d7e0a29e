#include <fmt/format.h>

#include "vantage/experiments/error_experiments.hpp"
#include "vantage/experiments/free_flyer.hpp"
#include "vantage/experiments/paper.hpp"

namespace vantage {
namespace {

constexpr double registration_sigma = 0.10;  // metres per axis

struct RegistrationMethod {
  const char* name;
  bool wants_overlap, convolves;
};

constexpr RegistrationMethod registration_methods[] = {{"overlap", true, false},
                                                       {"no overlap", false, false},
                                                       {"overlap, convolved", true, true},
                                                       {"no overlap, convolved", false, true}};

ReconstructOptions options_of(const RegistrationMethod& method) {
  ReconstructOptions options = free_flyer();
  options.max_views = 20;
  options.registration = "icp";
  options.positioning_error = Vec3::Constant(registration_sigma);
  if (method.convolves) options.convolve = "on";
  if (!method.wants_overlap) {
    // The factor of eq. 7 then grows with the share of occplane voxels alone: the best view sees nothing that is known.
    options.alpha_oc = 0;
    options.alpha_op = 1;
  }
  return options;
}

/// Of the scans after the first, per cent that registration refused.
double refused(const RunOutcome& outcome) {
  const double scans = outcome.number("views") - 1;
  return scans > 0 ? 100 * outcome.number("failed_scans") / scans : 0;
}

/// Farthest that a merged scan lies off its true pose, millimetres.
double worst_merged(const RunOutcome& outcome) {
  const std::vector<double>& merged = outcome.list("merged");
  const std::vector<double>& error = outcome.list("position_error");
  double worst = 0;
  for (std::size_t i = 0; i < merged.size(); ++i) worst = merged[i] > 0 ? std::max(worst, 1000 * error[i]) : worst;
  return worst;
}

}  // namespace

Experiment registration_experiment(const ExperimentOptions& options) {
  using Kind = ExperimentTable::Column::Kind;
  Experiment experiment("registration");
  std::vector<std::pair<std::string, std::vector<RunGroup>>> objects;
  for (const std::string object_name : {"mug", "sgi_logo"}) {
    const PaperObject object = paper_object(object_name, options.folder());
    std::vector<RunGroup> groups;
    for (const RegistrationMethod& method : registration_methods)
      groups.push_back(experiment.add(runs_with_seeds(fmt::format("{}, ICP, {}", object_name, method.name),
                                                      object.object, options_of(method), options.seeds)));
    objects.emplace_back(object.title(), groups);
  }
  experiment.report = [objects](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    ExperimentTable table;
    table.name = "registration";
    table.title = "Scans that registration refuses";
    table.row_title = "object, utility";
    table.note =
        "ICP in the loop, first pose exact, error 10 cm per axis. Refused: of the scans after the first. No overlap: "
        "alpha_oc = 0, alpha_op = 1. Differences against the first row of the object, paired by seed.";
    table.columns = {{"refused [%]", 1},  {"more refused [points]", 1, Kind::difference},
                     {"overlap [%]", 1},  {"worst merged [mm]", 1},
                     {"coverage [%]", 2}, {"more coverage [points]", 2, Kind::difference},
                     {"views", 1}};
    for (const auto& [title, groups] : objects) {
      const auto runs = outcomes.paired(groups, 2);
      const std::vector<double> first_refused = each(runs[0], refused);
      const std::vector<double> first_coverage = each(runs[0], mean_coverage);
      for (std::size_t k = 0; k < runs.size(); ++k) {
        const auto overlap = [](const RunOutcome& o) {
          const std::vector<double>& list = o.list("registration_overlap");
          double sum = 0;
          for (std::size_t i = 1; i < list.size(); ++i) sum += 100 * list[i];
          return list.size() > 1 ? sum / static_cast<double>(list.size() - 1) : 100;
        };
        const std::vector<double> failures = each(runs[k], refused);
        const std::vector<double> coverage = each(runs[k], mean_coverage);
        ExperimentTable::Cell more_failures = std::monostate();
        ExperimentTable::Cell more_coverage = std::monostate();
        if (k > 0) {
          more_failures = paired_difference(first_refused, failures);
          more_coverage = paired_difference(first_coverage, coverage);
        }
        table.rows.push_back({fmt::format("{}: {}", title, registration_methods[k].name),
                              {estimate(failures), more_failures, estimate(each(runs[k], overlap)),
                               estimate(each(runs[k], worst_merged)), estimate(coverage), more_coverage,
                               estimate(numbers(runs[k], "views"))}});
      }
    }
    return {table};
  };
  return experiment;
}

}  // namespace vantage
