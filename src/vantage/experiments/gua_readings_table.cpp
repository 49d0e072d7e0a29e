#include <fmt/format.h>

#include <functional>

#include "vantage/experiments/paper.hpp"
#include "vantage/experiments/ratio.hpp"
#include "vantage/experiments/tables.hpp"
#include "vantage/formats/mesh_file.hpp"

namespace vantage {
namespace {

/// One reading of section 8.4: an object, options and initial views.
struct GuaReading {
  std::string name;
  std::shared_ptr<const SweepObject> object;
  ReconstructOptions options;
  int starts = 20;
};

GuaReading changed(const GuaReading& base, const std::string& name,
                   const std::function<void(ReconstructOptions&)>& change) {
  GuaReading reading = base;
  reading.name = name;
  change(reading.options);
  return reading;
}

std::vector<GuaReading> gua_readings(const ExperimentOptions& options) {
  const std::shared_ptr<const SweepObject> mug = paper_object("mug", options.folder()).object;
  const GuaReading base{"the mug, 20 initial views (figure 9)", mug, {}};
  std::vector<GuaReading> all{base, base};
  all.back().name = "the mug, all 80 initial views";
  all.back().starts = 80;
  all.push_back(changed(base, "multi-resolution search", [](auto& o) { o.search = "multi-resolution"; }));
  all.push_back(changed(base, "ideal rays (eq. 14)", [](auto& o) { o.rays = "ideal"; }));
  all.push_back(changed(base, "320 candidates", [](auto& o) { o.candidates = "sphere:320:2"; }));
  all.push_back(changed(base, "quality against the ray", [](auto& o) { o.quality = "ray"; }));
  all.push_back(changed(base, "stop at 2 occplane voxels", [](auto& o) { o.stop_occplane = 2; }));
  all.push_back(changed(base, "no navigation factor", [](auto& o) { o.navigation = false; }));
  all.push_back(changed(base, "rho = 0.5", [](auto& o) { o.rho = 0.5; }));
  all.push_back(changed(base, "alpha 0.3 and 0.7", [](auto& o) { o.alpha_oc = 0.3, o.alpha_op = 0.7; }));
  all.push_back(changed(base, "incidence up to 70 degrees", [](auto& o) { o.max_incidence = 70; }));
  if (options.folder()) {
    all.push_back(base);
    all.back().name = "the mug that is built in";
    all.back().object = paper_object("mug", std::nullopt).object;
    const std::filesystem::path scanned = *options.folder() / "ycb_025_mug.ply";
    if (std::filesystem::exists(scanned)) {
      all.push_back(base);
      all.back().name = "a scanned mug (YCB)";
      all.back().object = std::make_shared<SweepObject>("ycb_025_mug", read_mesh(scanned), 0.815, "ycb_025_mug.ply");
    }
  }
  for (const PaperObject& other : paper_objects(options.folder())) {
    if (other.object->name() == mug->name()) continue;
    all.push_back(base);
    all.back().name = fmt::format("{}, 20 initial views", other.object->name());
    all.back().object = other.object;
  }
  return all;
}

}  // namespace

Experiment gua_readings_table(const ExperimentOptions& options) {
  using Kind = ExperimentTable::Column::Kind;
  Experiment experiment("figure9-readings");
  const std::vector<GuaReading> all = gua_readings(options);
  std::vector<RunGroup> combined, gua;
  for (const GuaReading& reading : all) {
    ReconstructOptions run = reading.options;
    combined.push_back(experiment.add(runs_from_starts(reading.name, reading.object, run, reading.starts)));
    run.utility = "gua";
    gua.push_back(experiment.add(runs_from_starts(reading.name + ", gua", reading.object, run, reading.starts)));
  }
  experiment.report = [=](const Outcomes& outcomes) -> std::vector<ExperimentReport::Part> {
    ExperimentTable table;
    table.name = "figure9-readings";
    table.title = "Figure 9 under other readings";
    table.note =
        "Combination of factors over greatest unknown area: ratios of the means with the 95 % interval of the paired "
        "difference. The paper: views 1.06, occupied about 1, quality above 1, distance below 1.";
    table.row_title = "reading";
    table.columns = {{"views", 3, Kind::difference},
                     {"occupied", 3, Kind::difference},
                     {"quality", 3, Kind::difference},
                     {"distance", 3, Kind::difference}};
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto paired = outcomes.paired({combined[i], gua[i]}, 2);
      ExperimentTable::Row row{all[i].name, {}};
      for (const char* measure : {"views", "occupied", "quality", "distance"})
        row.cells.emplace_back(ratio_of_means(numbers(paired[0], measure), numbers(paired[1], measure)));
      table.rows.push_back(std::move(row));
    }
    return {table};
  };
  return experiment;
}

}  // namespace vantage
