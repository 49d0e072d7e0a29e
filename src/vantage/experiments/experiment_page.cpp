#include <nlohmann/json.hpp>

#include "vantage/experiments/experiment_report.hpp"
#include "vantage/report/report.hpp"
#include "vantage/report/svg.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

/// The figures in their order: curves as numbers, which the page draws itself, everything else as a finished picture.
/// `all` are the figures of json(), one per plot.
Json page_figures(const ExperimentReport& report, const Json& all) {
  Json figures = Json::array();
  for (const ExperimentReport::Part& part : report.parts) {
    const auto* figure = std::get_if<ExperimentFigure>(&part);
    if (figure == nullptr) continue;
    for (const ExperimentFigure::Plot& plot : figure->plots) {
      Json entry = all.at(figures.size());
      if (!std::holds_alternative<LineChart>(plot))
        entry = {{"kind", entry["kind"]},
                 {"name", figure->name},
                 {"title", std::visit([](const auto& p) { return p.title; }, plot)},
                 {"svg", std::visit([](const auto& p) { return svg_plot(p); }, plot)}};
      entry["figure"] = figure->title;
      entry["note"] = figure->note;
      figures.push_back(std::move(entry));
    }
  }
  return figures;
}

}  // namespace

std::string experiment_page(const ExperimentReport& report) {
  Json document = json(report);
  document["figures"] = page_figures(report, document["figures"]);
  document["svg_style"] = plot_style();
  return fill_page(viewer_page(), document, html_body(report));
}

}  // namespace vantage
