#include "vantage/experiments/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "vantage/core/error.hpp"
#include "vantage/experiments/compare_measures.hpp"
#include "vantage/experiments/external_planner.hpp"
#include "vantage/experiments/known_object.hpp"
#include "vantage/experiments/paper.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/utility/registry.hpp"

namespace vantage {
namespace {

using Objects = std::vector<std::shared_ptr<const SweepObject>>;

/// What is compared: groups[object][method].
struct Comparison {
  Objects objects;
  std::vector<std::string> methods;  // the baseline first
  std::vector<std::vector<RunGroup>> groups;
  int budget = 0;
  std::string conditions;
  std::string coverage;  // the list of a run's outcome that its goals are of
  RobotTime time;
};

/// At the size that the protocol gives all objects, if it does.
std::shared_ptr<const SweepObject> sized(std::shared_ptr<const SweepObject> object, const Protocol& protocol) {
  if (!protocol.size) return object;
  return std::make_shared<SweepObject>(object->name(), object->mesh(), *protocol.size, object->source());
}

Objects objects_to_compare(const ExperimentOptions& options) {
  Objects objects;
  const Protocol& protocol = protocol_by_name(options.compare.protocol);
  if (options.compare.shapes == "all") {
    for (const PaperObject& paper : paper_objects(options.folder())) objects.push_back(sized(paper.object, protocol));
    return objects;
  }
  for (std::size_t from = 0; from <= options.compare.shapes.size();) {
    const std::size_t to = std::min(options.compare.shapes.find(',', from), options.compare.shapes.size());
    const std::string name = options.compare.shapes.substr(from, to - from);
    from = to + 1;
    if (const std::filesystem::path file(name); file.has_extension()) {
      const double size = protocol.size.value_or(0.815);  // as the paper's objects
      objects.push_back(std::make_shared<SweepObject>(file.stem().string(), read_mesh(file), size, name));
    } else {
      objects.push_back(sized(paper_object(name, options.folder()).object, protocol));
    }
  }
  return objects;
}

void add_accuracy(const SimulatedRun& run, const SimulatedObject& object, RunOutcome& outcome) {
  outcome.numbers["accuracy"] = object.truth().accuracy(run.model.surface.cloud()).root_mean_square;
}

/// The list `point_coverage` of a run.
ExtraMeasures::OnScan counting_points(const SweepObject& object, const ReconstructOptions& options,
                                      const PointMetric& metric) {
  const auto coverage = std::make_shared<PointCoverage>(*object.nothing_scanned(options, metric));
  return [coverage](const ScanRecord& record, const Scan& scan, RunOutcome& outcome) {
    if (record.merged) {
      std::vector<Vec3> points = points_of(scan).points;
      for (Vec3& point : points) point = record.registered.world_from_sensor * point;
      coverage->add(points);
    }
    outcome.lists["point_coverage"].push_back(coverage->share());
  };
}

ExtraMeasures measures_for(const std::string& method, const CompareOptions& compare) {
  ExtraMeasures extra{"accuracy", add_accuracy};
  if (const auto& metric = protocol_by_name(compare.protocol).metric) {
    extra.name += concat(", ", metric->samples, " points, ", metric->tolerance, " m, reachable: ", metric->reachable);
    extra.per_scan = [metric](const SweepObject& object, const ReconstructOptions& run) {
      return counting_points(object, run, *metric);
    };
  }
  if (method == "known-greedy") {
    extra.utility = [](const SimulatedObject& o, const ReconstructOptions& r) { return known_greedy_utility(o, r); };
  } else if (method == "known-optimum") {
    extra.utility = [](const SimulatedObject& o, const ReconstructOptions& r) { return known_optimum_utility(o, r); };
  } else if (method == "external") {
    extra.utility = [compare](const SimulatedObject&, const ReconstructOptions&) {
      return external_planner({*compare.external, compare.external_timeout});
    };
    extra.name += ", external: " + *compare.external;
  } else {
    return extra;
  }
  extra.name += ", " + method;
  return extra;
}

std::string conditions_text(const CompareOptions& c) {
  const Protocol& protocol = protocol_by_name(c.protocol);
  std::string text = fmt::format("Protocol {}: {}", protocol.name, protocol.text);
  if (!c.depth_noise.isZero(0)) {
    text += fmt::format(", depth noise {:.1f} mm + {:.1f} mm/m2", 1000 * c.depth_noise.x(), 1000 * c.depth_noise.y());
  }
  if (!c.positioning_error.isZero(0)) {
    text += fmt::format(", positioning error {:.1f}, {:.1f}, {:.1f} cm", 100 * c.positioning_error.x(),
                        100 * c.positioning_error.y(), 100 * c.positioning_error.z());
  }
  return text + fmt::format(", registration {}.", c.registration);
}

Comparison add_runs(Experiment& experiment, const ExperimentOptions& options) {
  Comparison comparison{objects_to_compare(options),
                        options.compare.methods(),
                        {},
                        options.compare.budget(),
                        conditions_text(options.compare),
                        protocol_by_name(options.compare.protocol).metric ? "point_coverage" : "coverage",
                        options.compare.time};
  for (const auto& object : comparison.objects) {
    std::vector<RunGroup> of_object;
    for (const std::string& method : comparison.methods) {
      const ExtraMeasures extra = measures_for(method, options.compare);
      ReconstructOptions run = options.compare.run_options();
      if (!extra.utility) run.utility = method;
      const int views = static_cast<int>(run.candidate_views().views.size());
      std::vector<SweepRun> runs;
      for (int i = 0; i < options.starts; ++i) {
        run.initial_view = views * i / options.starts;
        run.seed = static_cast<std::uint64_t>(i) + 1;
        runs.push_back(
            reconstruction_run(fmt::format("{}, {}, start {}", object->name(), method, i), object, run, extra));
      }
      of_object.push_back(experiment.add(std::move(runs)));
    }
    comparison.groups.push_back(std::move(of_object));
  }
  return comparison;
}

/// measures[method][start] of one object.
using Measures = std::vector<std::vector<CompareMeasures>>;

template <class Member>
std::vector<double> pick(const std::vector<CompareMeasures>& runs, const Member& member) {
  std::vector<double> values;
  for (const CompareMeasures& run : runs) values.push_back(member(run));
  return values;
}

double views_to_end(const CompareMeasures& m) { return m.views.back(); }

/// Mean over the starts of the rank among the methods by views to the last goal.
std::vector<double> mean_ranks(const std::vector<Measures>& objects) {
  std::vector<double> mean(objects.front().size(), 0.0);
  double count = 0;
  for (const Measures& object : objects) {
    for (std::size_t start = 0; start < object.front().size(); ++start) {
      std::vector<double> views;
      for (const auto& method : object) views.push_back(views_to_end(method[start]));
      const std::vector<double> ranks = ranks_of(views);
      for (std::size_t m = 0; m < mean.size(); ++m) mean[m] += ranks[m];
      ++count;
    }
  }
  for (double& each : mean) each /= count;
  return mean;
}

ExperimentTable table_of(const Comparison& comparison, const Measures& methods, const std::vector<double>& ranks) {
  using Kind = ExperimentTable::Column::Kind;
  ExperimentTable table;
  table.row_title = "utility";
  for (const double goal : CompareMeasures::goals)
    table.columns.push_back({fmt::format("views to {:.0f} %", 100 * goal), 1});
  table.columns.push_back({"difference at 99 %", 2, Kind::difference});
  table.columns.push_back({"missed", 1});
  table.columns.push_back({"mean rank", 2});
  table.columns.push_back({"distance to 99 % [m]", 1});
  table.columns.push_back({"difference [m]", 1, Kind::difference});
  table.columns.push_back({"time to 99 % [s]", 1});
  table.columns.push_back({"difference [s]", 1, Kind::difference});
  table.columns.push_back({"area under curve [%]", 2});
  table.columns.push_back({"least overlap", 2});
  table.columns.push_back({"mean overlap", 2});
  table.columns.push_back({"accuracy [mm]", 2});
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const std::vector<CompareMeasures>& runs = methods[m];
    const std::vector<CompareMeasures>& base = methods.front();
    ExperimentTable::Row row{comparison.methods[m], {}};
    for (std::size_t g = 0; g < CompareMeasures::goals.size(); ++g) {
      row.cells.emplace_back(estimate(pick(runs, [g](const CompareMeasures& c) { return c.views[g]; })));
    }
    const auto distance = [](const CompareMeasures& c) { return c.distance; };
    const auto difference = [&](const auto& member) -> ExperimentTable::Cell {
      if (m == 0) return {};
      return paired_difference(pick(base, member), pick(runs, member));
    };
    row.cells.push_back(difference(views_to_end));
    row.cells.emplace_back(estimate(pick(runs, [](const CompareMeasures& c) { return c.missed; })));
    row.cells.emplace_back(fmt::format("{:.2f}", ranks[m]));
    row.cells.emplace_back(estimate(pick(runs, distance)));
    row.cells.push_back(difference(distance));
    const auto seconds = [](const CompareMeasures& c) { return c.seconds; };
    row.cells.emplace_back(estimate(pick(runs, seconds)));
    row.cells.push_back(difference(seconds));
    row.cells.emplace_back(estimate(pick(runs, [](const CompareMeasures& c) { return c.area_under_curve; })));
    const std::vector<double> overlaps = pick(runs, [](const CompareMeasures& c) { return c.min_overlap; });
    row.cells.emplace_back(fmt::format("{:.3f}", *std::min_element(overlaps.begin(), overlaps.end())));
    row.cells.emplace_back(estimate(pick(runs, [](const CompareMeasures& c) { return c.mean_overlap; })));
    row.cells.emplace_back(estimate(pick(runs, [](const CompareMeasures& c) { return 1000 * c.accuracy; })));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Two tables that fit on a page: views with ranks, and the way with overlap and accuracy.
void add_tables(std::vector<ExperimentReport::Part>& parts, const ExperimentTable& all) {
  constexpr std::ptrdiff_t of_views = CompareMeasures::goals.size() + 3;
  ExperimentTable views = all;
  ExperimentTable way = all;
  way.name += "-way";
  way.title += ": way, overlap, accuracy";
  views.columns.erase(views.columns.begin() + of_views, views.columns.end());
  for (auto& row : views.rows) row.cells.erase(row.cells.begin() + of_views, row.cells.end());
  way.columns.erase(way.columns.begin(), way.columns.begin() + of_views);
  for (auto& row : way.rows) row.cells.erase(row.cells.begin(), row.cells.begin() + of_views);
  parts.emplace_back(std::move(views));
  parts.emplace_back(std::move(way));
}

/// Coverage after every scan of the methods that cover fastest, the baseline among them.
LineChart coverage_chart(const Comparison& comparison, const std::string& object,
                         const std::vector<std::vector<RunOutcome>>& runs, const Measures& methods) {
  constexpr std::size_t shown = 6;
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto area = [&](std::size_t m) {
    return estimate(pick(methods[m], [](const CompareMeasures& c) { return c.area_under_curve; })).mean;
  };
  std::stable_sort(order.begin() + 1, order.end(), [&](std::size_t a, std::size_t b) { return area(a) > area(b); });
  order.resize(std::min(order.size(), shown));
  LineChart chart;
  chart.title = object;
  chart.x.label = "scan";
  chart.x.ticks = PlotAxis::Ticks::whole;
  chart.y.label = "coverage [%]";
  constexpr std::size_t scans = 12;
  for (const std::size_t m : order) {
    LineSeries series;
    series.name = comparison.methods[m];
    for (std::size_t scan = 1; scan <= scans; ++scan) {
      const Estimate covered =
          estimate(each(runs[m], [&](const RunOutcome& o) { return 100 * after_scan(o, comparison.coverage, scan); }));
      series.x.push_back(static_cast<double>(scan));
      series.y.push_back(covered.mean);
      series.low.push_back(covered.low);
      series.high.push_back(std::min(covered.high, 100.0));
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

std::vector<ExperimentReport::Part> report_of(const Comparison& comparison, const Outcomes& outcomes) {
  std::vector<Measures> objects;
  ExperimentFigure figure;
  figure.name = "compare-curves";
  figure.title = "Coverage after every scan";
  figure.note = fmt::format(
      "{} Means over the starts with 95 % intervals; the baseline {} and the methods of largest "
      "area under the curve. A finished run keeps its last value.",
      comparison.conditions, comparison.methods.front());
  for (std::size_t k = 0; k < comparison.objects.size(); ++k) {
    const auto runs = outcomes.paired(comparison.groups[k], 2);
    Measures measures;
    for (const auto& method : runs) {
      std::vector<CompareMeasures> of_method;
      for (const RunOutcome& run : method)
        of_method.push_back(measure_run(run, comparison.budget, comparison.coverage, comparison.time));
      measures.push_back(std::move(of_method));
    }
    figure.plots.emplace_back(coverage_chart(comparison, comparison.objects[k]->name(), runs, measures));
    objects.push_back(std::move(measures));
  }
  // Starts at which every object has a run of every method.
  std::size_t starts = objects.front().front().size();
  for (const Measures& object : objects) starts = std::min(starts, object.front().size());
  Measures sums(comparison.methods.size());
  for (std::size_t m = 0; m < sums.size(); ++m) {
    for (std::size_t start = 0; start < starts; ++start) {
      std::vector<CompareMeasures> over;
      for (const Measures& object : objects) over.push_back(object[m][start]);
      sums[m].push_back(over_objects(over));
    }
  }
  std::vector<ExperimentReport::Part> parts;
  ExperimentTable all = table_of(comparison, sums, mean_ranks(objects));
  all.name = "compare";
  all.title = fmt::format("All {} objects", objects.size());
  all.note = fmt::format(
      "{} Views, distances, times and misses are summed over the objects, the rest are means (least overlap: the "
      "least). "
      "Means over "
      "{} starts with standard deviation; differences from {} with 95 % intervals, paired by start; missed: runs that "
      "do not come to 99 %. A run that misses a goal "
      "counts with its budget of {} views. Times count {} s per scan and the path at {} m/s. Ranks by views to 99 %, "
      "over objects and starts.",
      comparison.conditions, starts, comparison.methods.front(), comparison.budget, comparison.time.scan,
      comparison.time.speed);
  add_tables(parts, all);
  parts.emplace_back(std::move(figure));
  for (std::size_t k = 0; k < objects.size(); ++k) {
    ExperimentTable table = table_of(comparison, objects[k], mean_ranks({objects[k]}));
    table.name = "compare-" + comparison.objects[k]->name();
    table.title = comparison.objects[k]->name();
    add_tables(parts, table);
  }
  return parts;
}

ExperimentTable compared_times_table(const Comparison& comparison, const Outcomes& outcomes) {
  ExperimentTable table;
  table.name = "compare-times";
  table.content = ExperimentContent::times;
  table.title = "Planning times";
  table.row_title = "utility";
  table.note = "Milliseconds per plan as the clock said while several runs shared the machine; they do not repeat.";
  for (const auto& object : comparison.objects) table.columns.push_back({object->name() + " [ms]", 1});
  for (std::size_t m = 0; m < comparison.methods.size(); ++m) {
    ExperimentTable::Row row{comparison.methods[m], {}};
    for (std::size_t k = 0; k < comparison.objects.size(); ++k) {
      std::vector<double> means;
      for (const RunOutcome& run : outcomes.of(comparison.groups[k][m])) {
        const std::vector<double>& plans = run.time("plan");
        if (plans.size() < 2) continue;  // the first scan is not planned
        means.push_back(std::accumulate(plans.begin() + 1, plans.end(), 0.0) / static_cast<double>(plans.size() - 1));
      }
      row.cells.push_back(means.empty() ? ExperimentTable::Cell() : ExperimentTable::Cell(estimate(means)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

Experiment comparison(const ExperimentOptions& options) {
  Experiment experiment("compare");
  const Comparison compared = add_runs(experiment, options);
  experiment.report = [compared](const Outcomes& outcomes) {
    std::vector<ExperimentReport::Part> parts = report_of(compared, outcomes);
    parts.emplace_back(compared_times_table(compared, outcomes));
    return parts;
  };
  return experiment;
}

}  // namespace vantage
