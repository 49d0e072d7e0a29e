#include <fmt/format.h>

#include <functional>

#include "vantage/experiments/free_flyer.hpp"
#include "vantage/experiments/paper.hpp"
#include "vantage/experiments/tables.hpp"

namespace vantage {
namespace {

constexpr double published_sigma = 0.10;  // metres, per axis

/// One reading of section 9: an error, and what else is different.
struct ConvolutionReading {
  std::string name;
  std::function<void(ReconstructOptions&)> change = [](ReconstructOptions&) {};
  double sigma = published_sigma;
};

std::vector<ConvolutionReading> convolution_readings() {
  std::vector<ConvolutionReading> all{{"figure 11: the sensor's rays, 10 cm"}};
  all.push_back({"the planner believes 15 cm", [](auto& o) { o.believed_error = "0.15,0.15,0.15"; }});
  all.push_back({"the planner believes 20 cm", [](auto& o) { o.believed_error = "0.2,0.2,0.2"; }});
  all.push_back({"no error, the planner believes 20 cm", [](auto& o) { o.believed_error = "0.2,0.2,0.2"; }, 0});
  all.push_back({"cells of 17 cm, 25 per side", [](auto& o) { o.candidates = "cube:25:4.1:0.82:1.9"; }});
  all.push_back({.name = "error of 5 cm", .sigma = 0.05});
  all.push_back({.name = "error of 15 cm", .sigma = 0.15});
  all.push_back({.name = "error of 20 cm", .sigma = 0.20});
  all.push_back({.name = "error of 30 cm", .sigma = 0.30});
  all.push_back({"ideal rays (eq. 14)", [](auto& o) { o.rays = "ideal"; }});
  all.push_back({"sensor of 45 x 34.5 degrees", [](auto& o) { o.camera = "45x34.5:320x240"; }});
  all.push_back({"greatest unknown area (gua)", [](auto& o) { o.utility = "gua"; }});
  all.push_back({"with the navigation factor", [](auto& o) { o.navigation = true, o.travel = "straight"; }});
  return all;
}

struct ReadingCase {
  std::string name;
  std::vector<RunGroup> groups;  // no error, error, convolved
};

}  // namespace

Experiment convolution_readings_table(const ExperimentOptions& options) {
  using Kind = ExperimentTable::Column::Kind;
  Experiment experiment("figure11-readings");
  std::vector<ReadingCase> cases;
  const PaperObject logo = paper_object("sgi_logo", options.folder());
  for (const ConvolutionReading& reading : convolution_readings()) {
    const auto add = [&](const char* method, double sigma, const char* convolve) {
      ReconstructOptions run = free_flyer();
      reading.change(run);
      run.positioning_error = Vec3::Constant(sigma);
      run.convolve = convolve;
      if (run.convolve == "off") run.believed_error.reset();  // the same run, whatever is believed
      return experiment.add(
          runs_with_seeds(fmt::format("{}, {}", reading.name, method), logo.object, run, options.seeds));
    };
    cases.push_back(
        {reading.name,
         {add("no error", 0, "off"), add("error", reading.sigma, "off"), add("convolved", reading.sigma, "on")}});
  }
  const int seeds = options.seeds;
  experiment.report = [cases, seeds,
                       title = logo.title()](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    ExperimentTable table;
    table.name = "figure11-readings";
    table.title = "Figure 11 under other readings";
    table.row_title = "reading";
    table.note = fmt::format(
        "{}, mean coverage over scans {} to {}; {} seeds, differences paired by seed. Damage: what the robot without "
        "error is ahead of the standard method with it.",
        title, first_compared_scan, last_compared_scan, seeds);
    table.columns = {{"no error [%]", 2},
                     {"error [%]", 2},
                     {"convolved [%]", 2},
                     {"damage of the error [points]", 2, Kind::difference},
                     {"gain of convolution [points]", 2, Kind::difference},
                     {"scans to 95 % saved", 2, Kind::difference}};
    for (const ReadingCase& reading : cases) {
      const auto runs = outcomes.paired(reading.groups, 2);
      std::vector<std::vector<double>> covered, scans;
      for (const std::vector<RunOutcome>& method : runs) {
        covered.push_back(each(method, mean_coverage));
        scans.push_back(each(method, [](const RunOutcome& o) { return views_to(0.95, o); }));
      }
      table.rows.push_back(
          {reading.name,
           {estimate(covered[0]), estimate(covered[1]), estimate(covered[2]), paired_difference(covered[1], covered[0]),
            paired_difference(covered[1], covered[2]), paired_difference(scans[2], scans[1])}});
    }
    return {table};
  };
  return experiment;
}

}  // namespace vantage
