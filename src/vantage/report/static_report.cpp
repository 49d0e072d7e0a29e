#include "vantage/report/static_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vantage/report/html_page.hpp"
#include "vantage/report/report.hpp"
#include "vantage/report/run_scene.hpp"
#include "vantage/report/software_renderer.hpp"
#include "vantage/report/svg_plot.hpp"

namespace vantage {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Numbers figures and tables in the order in which they are written.
class Captions {
 public:
  [[nodiscard]] std::string figure(std::string_view text) { return fmt::format("Figure {}. {}", ++figures_, text); }
  [[nodiscard]] std::string table(std::string_view text) { return fmt::format("Table {}. {}", ++tables_, text); }

 private:
  int figures_ = 0, tables_ = 0;
};

std::string image(const Picture& picture, std::string_view description) {
  return fmt::format("<img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"{}\"/>\n", escape_markup(description),
                     picture.width, picture.height, png_data_uri(picture));
}

std::string percent(const std::optional<double>& share) {
  return share ? readable(100 * *share, *share > 0.99 ? 2 : 1) + " %" : "–";
}

std::string tiles(const ReportData& data) {
  const auto tile = [](std::string_view name, const std::string& value, std::string_view unit) {
    return fmt::format("<div><dt>{}</dt><dd>{}{}</dd></div>\n", name, escape_markup(value),
                       unit.empty() ? "" : fmt::format(" <small>{}</small>", unit));
  };
  std::string text = "<dl class=\"tiles\">\n" + tile("scans", std::to_string(data.scans.size()), "");
  if (!data.scans.empty()) {
    const ScanRecord& last = data.scans.back();
    if (last.coverage) text += tile("coverage", readable(100 * *last.coverage, *last.coverage > 0.99 ? 2 : 1), "%");
    text += tile("distance", readable(last.distance, 2), "m");
    text += tile("occupied voxels", readable(static_cast<double>(last.labels.occupied)), "");
    text += tile("mean quality", readable(last.mean_quality, 3), "");
  }
  if (data.seconds) text += tile("time", readable(*data.seconds, *data.seconds < 10 ? 2 : 0), "s");
  return text + "</dl>\n";
}

std::string captioned(const std::string& picture, std::string_view name) {
  return fmt::format("<div>{}<span>{}</span></div>\n", picture, escape_markup(name));
}

std::string views_section(const ReportData& data, Captions& captions) {
  if (data.scans.empty()) return "";
  const PictureScene scene = views_scene(data);
  const RenderOptions options{.width = 1040, .height = 600};
  const PictureCamera camera = camera_around(scene, side_of(data.up, 28, 24), 1040.0 / 600, data.up);
  std::string key = "The model among its views. ";
  key += "Cameras: the scans in their order from 0; line: the way of the sensor; dots: the candidate views.";
  if (std::any_of(data.scans.begin(), data.scans.end(), [](const ScanRecord& scan) { return !scan.merged; }))
    key += " Grey cameras: scans that could not be registered and were not merged.";
  return html_figure(image(render(scene, camera, options), "The model with the cameras of all scans around it"),
                     captions.figure(key));
}

std::string model_section(const ReportData& data, Captions& captions) {
  const PictureScene scene = model_scene(data);
  if (scene.solid_box().isEmpty() || scene.solid_box().diagonal().norm() == 0) return "";
  const SkyLight sky(scene);
  const RenderOptions options{.width = 400, .height = 320, .floor = floor_under(scene, data.up)};
  struct Look {
    std::string name;
    double turn, rise;
  };
  const std::vector<Look> looks{{"front", 25, 22}, {"right", 115, 22}, {"back", 205, 22},
                                {"left", 295, 22}, {"above", 25, 68},  {"below", 25, -50}};
  std::string pictures = "<div class=\"three\">\n";
  for (const Look& look : looks) {
    const PictureCamera camera = camera_around(scene, side_of(data.up, look.turn, look.rise), 400.0 / 320, data.up);
    pictures += captioned(image(render(scene, sky, camera, options), "The model, " + look.name), look.name);
  }
  const bool mesh = data.mesh != nullptr && !data.mesh->triangles.empty();
  const bool cloud = data.cloud != nullptr && data.cloud->size() > 0;
  const std::string what =
      mesh    ? fmt::format("surface of {} triangles", readable(static_cast<double>(data.mesh->triangles.size())))
      : cloud ? fmt::format("cloud of {} points", readable(static_cast<double>(data.cloud->size())))
              : std::string("occupied voxels");
  return "<h2>Model</h2>\n" +
         html_figure(pictures + "</div>\n", captions.figure(fmt::format("The model from six sides ({}).", what)));
}

std::string voxel_section(const ReportData& data, Captions& captions) {
  if (data.map == nullptr || data.map->count(Label::occupied) == 0) return "";
  const VoxelMap& map = *data.map;
  struct Look {
    std::string name;
    VoxelPaint paint;
  };
  const std::vector<Look> looks{{"quality from 0 (dark) to 1 (yellow)", paint_quality(map)},
                                {"normals: x, y, z as red, green, blue", paint_normals(map)},
                                {"labels: occupied (pale), occplane (blue)", paint_labels(map)}};
  std::string pictures = "<div class=\"three\">\n";
  std::optional<PictureCamera> camera;
  std::optional<SkyLight> sky;  // the same solids but for the occplane voxels: one light serves all
  for (const Look& look : looks) {
    PictureScene scene;
    add_voxels(scene, map, look.paint);
    if (!camera) camera = camera_around(scene, side_of(data.up, 25, 28), 400.0 / 320, data.up);
    if (!sky) sky.emplace(scene);
    const RenderOptions options{.width = 400, .height = 320};
    pictures += captioned(image(render(scene, *sky, *camera, options), look.name), look.name);
  }
  return html_figure(pictures + "</div>\n", captions.figure(fmt::format(
                                                "The voxel map: {} occupied voxels of {} mm.",
                                                readable(static_cast<double>(map.count(Label::occupied))),
                                                readable(1000 * map.grid().length, map.grid().length < 0.01 ? 1 : 0))));
}

/// One value per scan.
template <class Value>
LineSeries over_scans(const ReportData& data, const std::string& name, const Value& value) {
  LineSeries series;
  series.name = name;
  for (const ScanRecord& scan : data.scans) {
    series.x.push_back(scan.scan);
    series.y.push_back(value(scan));
  }
  return series;
}

std::string curves_section(const ReportData& data, Captions& captions) {
  if (data.scans.empty()) return "";
  const PlotAxis scans{.label = "scan", .ticks = PlotAxis::Ticks::whole};
  const auto plot = [&](std::string title, std::string y_label, PlotAxis::Start start, std::vector<LineSeries> series) {
    return svg_plot(LineChart{.title = std::move(title),
                              .x = scans,
                              .y = {.label = std::move(y_label), .start = start},
                              .series = std::move(series),
                              .paper = {}});
  };
  const auto share = [](const std::optional<double>& value) { return value ? 100 * *value : unknown; };
  std::string plots = "<div class=\"two\">\n";
  const bool coverage =
      std::any_of(data.scans.begin(), data.scans.end(), [](const auto& scan) { return scan.coverage.has_value(); });
  if (coverage)
    plots +=
        plot("Coverage", "share of the true surface [%]", PlotAxis::Start::zero,
             {over_scans(data, "of what can be seen", [&](const ScanRecord& scan) { return share(scan.coverage); }),
              over_scans(data, "of everything", [&](const ScanRecord& scan) { return share(scan.coverage_all); })});
  plots += plot(
      "Voxels", "voxels", PlotAxis::Start::zero,
      {over_scans(data, "occupied", [](const ScanRecord& scan) { return static_cast<double>(scan.labels.occupied); }),
       over_scans(data, "occplane", [](const ScanRecord& scan) { return static_cast<double>(scan.labels.occplane); }),
       over_scans(data, "new occupied",
                  [](const ScanRecord& scan) { return static_cast<double>(scan.new_occupied); })});
  plots += plot("Mean quality", "cosine", PlotAxis::Start::data,
                {over_scans(data, "quality", [](const ScanRecord& scan) { return scan.mean_quality; })});
  plots += plot("Distance travelled", "distance [m]", PlotAxis::Start::zero,
                {over_scans(data, "distance", [](const ScanRecord& scan) { return scan.distance; })});
  return "<h2>Over the scans</h2>\n" +
         html_figure(plots + "</div>\n", captions.figure("What every scan added, from scan 0, the initial view."));
}

std::string labels_section(const ReportData& data, Captions& captions) {
  if (data.scans.empty()) return "";
  HtmlTable table;
  table.caption = captions.table("Voxels of the enclosure by label after every scan.");
  table.columns = {{"scan", HtmlTable::Align::right, ""},        {"unmarked", HtmlTable::Align::right, ""},
                   {"empty", HtmlTable::Align::right, ""},       {"occluded", HtmlTable::Align::right, ""},
                   {"occplane", HtmlTable::Align::right, ""},    {"occupied", HtmlTable::Align::right, ""},
                   {"new occupied", HtmlTable::Align::right, ""}};
  for (const ScanRecord& scan : data.scans) {
    const LabelCounts& labels = scan.labels;
    std::vector<HtmlTable::Cell> row{{std::to_string(scan.scan)}};
    for (const std::int64_t count :
         {labels.unmarked, labels.empty, labels.occluded, labels.occplane, labels.occupied, scan.new_occupied})
      row.push_back({readable(static_cast<double>(count))});
    table.rows.push_back(row);
  }
  return html(table);
}

std::string choices_section(const ReportData& data, Captions& captions) {
  if (data.scans.empty()) return "";
  HtmlTable table;
  table.caption = captions.table(
      "The views taken. Counts, factors and utility are what the planner expected of the view when it chose it "
      "(visible "
      "occupied, occplane and unmarked voxels; equations 7, 10, 11, 12 and 13 of the paper).");
  const auto right = HtmlTable::Align::right, left = HtmlTable::Align::left;
  table.columns = {{"scan", right, ""},
                   {"view", right, "index of the candidate"},
                   {"n_oc", right, "visible occupied voxels"},
                   {"n_op", right, "visible occplane voxels"},
                   {"n_um", right, "visible unmarked voxels"},
                   {"f_area", right, "eq. 7"},
                   {"f_nav", right, "eq. 10"},
                   {"f_quality", right, "eq. 11"},
                   {"f_occl", right, "eq. 12"},
                   {"utility", right, "eq. 13"},
                   {"moved [m]", right, "distance so far"},
                   {"coverage", right, "of the surface that can be seen, after the scan"},
                   {"why", left, ""}};
  for (const ScanRecord& scan : data.scans) {
    std::vector<HtmlTable::Cell> row{{std::to_string(scan.scan)},
                                     {scan.candidate >= 0 ? std::to_string(scan.candidate) : "–"}};
    const auto add = [&](double value, int decimals) { row.push_back({readable(value, decimals)}); };
    const Evaluation* planned = scan.planned ? &*scan.planned : nullptr;
    for (const std::int32_t count : {planned ? planned->seen.occupied : -1, planned ? planned->seen.occplane : -1,
                                     planned ? planned->seen.unmarked : -1})
      add(count >= 0 ? count : unknown, 0);
    const Factors factors = planned ? planned->factors : Factors{0, 0, unknown, unknown, unknown, unknown};
    for (const double factor : {factors.f_area, factors.f_navigation, factors.f_quality, factors.f_occlusion})
      add(factor, 3);
    add(planned ? planned->utility : unknown, 3);
    add(scan.distance, 2);
    row.push_back({percent(scan.coverage)});
    std::string reason = scan.reason;
    if (!scan.merged) reason += (reason.empty() ? "" : "; ") + std::string("not merged: ") + scan.verdict;
    row.push_back({reason});
    table.rows.push_back(row);
  }
  return "<h2>Chosen views</h2>\n" + html(table);
}

std::string slices_section(const ReportData& data, Captions& captions) {
  std::vector<LabelSlice> slices;
  // The first scans change most: take the first three and the last of what was kept.
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < data.layers.size(); ++i)
    if (i < 3 || i + 1 == data.layers.size()) shown.push_back(i);
  for (const std::size_t i : shown)
    slices.push_back({fmt::format("after scan {}", data.layers[i].first), data.layers[i].second});
  if (slices.empty() && data.map != nullptr)
    slices.push_back({"after the last scan", label_layer(*data.map, middle_layer(*data.map))});
  if (slices.empty()) return "";
  std::string plots = slices.size() > 1 ? "<div class=\"four\">\n" : "<div>\n";
  for (LabelSlice& slice : slices) {
    if (slices.size() == 1) slice.width = slice.height = 520;
    plots += svg_plot(slice);
  }
  const double height = slices.front().layer.box.center().z();
  return "<h2>A slice through the labels</h2>\n" +
         html_figure(plots + "</div>\n", captions.figure(fmt::format(
                                             "Horizontal slice through the enclosure at z = {} m with the number of "
                                             "voxels per label.",
                                             readable(height, 2))));
}

std::string times_section(const ReportData& data, Captions& captions) {
  if (data.scans.empty()) return "";
  BarChart chart;
  chart.title = "Time per scan";
  chart.category_label = "scan";
  chart.y.label = "time [ms]";
  chart.arrangement = BarChart::Arrangement::stacked;
  chart.width = 720;
  chart.series = {{"plan", {}, {}, {}, {}},
                  {"scan", {}, {}, {}, {}},
                  {"registration", {}, {}, {}, {}},
                  {"integration", {}, {}, {}, {}}};
  for (const ScanRecord& scan : data.scans) {
    chart.categories.push_back(std::to_string(scan.scan));
    const ScanTimings& seconds = scan.timings;
    const std::array<double, 4> parts{seconds.plan, seconds.scan, seconds.registration, seconds.integration};
    for (std::size_t k = 0; k < parts.size(); ++k) chart.series[k].value.push_back(1000 * parts[k]);
  }
  return "<h2>Times</h2>\n" +
         html_figure(svg_plot(chart), captions.figure("Wall-clock time of the stages of every scan."));
}

std::string options_section(const ReportData& data, Captions& captions) {
  if (data.options.empty()) return "";
  HtmlTable table;
  table.caption = captions.table("Options of the run.");
  table.columns = {{"option", HtmlTable::Align::left, ""}, {"value", HtmlTable::Align::left, ""}};
  for (const auto& [name, value] : data.options) table.rows.push_back({{name}, {value}});
  return "<h2>Options</h2>\n" + html(table);
}

}  // namespace

std::string report_summary(const ReportData& data) {
  if (data.scans.empty()) return "No scan has been taken yet.";
  const ScanRecord& last = data.scans.back();
  const std::size_t count = data.scans.size();
  std::string text =
      fmt::format("{} {} over a way of {} m", count, count == 1 ? "view" : "views", readable(last.distance, 2));
  text += last.coverage ? fmt::format(" covered {} of the surface that can be seen.", percent(last.coverage))
                        : fmt::format(" gave {} occupied voxels.", readable(static_cast<double>(last.labels.occupied)));
  if (!data.stop_reason.empty()) {
    text += " It stopped because " + data.stop_reason;
    if (data.stop_reason.back() != '.') text += '.';
  }
  return text;
}

std::string static_report_body(const ReportData& data) {
  Captions captions;
  std::string body = fmt::format("<style>\n{}</style>\n<article class=\"report\">\n", report_style());
  body += fmt::format("<p class=\"eyebrow\">Vantage · {}</p>\n<h1>{}</h1>\n<p class=\"lede\">{}</p>\n",
                      escape_markup(data.command), escape_markup(data.object), escape_markup(report_summary(data)));
  body += tiles(data);
  for (const auto section : {views_section, model_section, voxel_section, curves_section, labels_section,
                             choices_section, slices_section, times_section, options_section})
    body += section(data, captions);
  return body + fmt::format("<footer>{}</footer>\n</article>\n", escape_markup(data.program));
}

std::string report_page(RunData run, const VoxelMap& map, std::optional<double> seconds) {
  ReportData data = report_data(run, map);
  data.seconds = seconds;
  run.static_html = static_report_body(data);
  return report_html(run);
}

std::string static_report_html(const ReportData& data) {
  return html_page(data.object + " – Vantage", static_report_body(data));
}

}  // namespace vantage
