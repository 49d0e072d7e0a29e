#include "vantage/experiments/experiment_report.hpp"

#include <fmt/format.h>

#include "vantage/core/error.hpp"
#include "vantage/report/html_page.hpp"

namespace vantage {
namespace {

using Kind = ExperimentTable::Column::Kind;

void validate(const ExperimentTable& table) {
  for (const ExperimentTable::Row& row : table.rows)
    require(row.cells.size() == table.columns.size(), "table ", table.name, ", row '", row.name, "' has ",
            row.cells.size(), " cells: must have ", table.columns.size());
}

const Estimate* estimate_in(const ExperimentTable::Cell& cell) { return std::get_if<Estimate>(&cell); }

bool any_published(const ExperimentTable& table, std::size_t column) {
  for (const ExperimentTable::Row& row : table.rows)
    if (const Estimate* found = estimate_in(row.cells[column]); found != nullptr && found->published) return true;
  return false;
}

std::string with_spread(const Estimate& value, const ExperimentTable::Column& column) {
  if (column.kind == Kind::difference)
    return fmt::format("{}{} [{}, {}]", value.mean > 0 ? "+" : "", readable(value.mean, column.decimals),
                       readable(value.low, column.decimals), readable(value.high, column.decimals));
  const std::string mean = readable(value.mean, column.decimals);
  return value.runs > 1 ? mean + " ± " + readable(value.sd, column.decimals) : mean;
}

HtmlTable::Cell html_cell(const ExperimentTable::Cell& cell, const ExperimentTable::Column& column) {
  if (const std::string* text = std::get_if<std::string>(&cell)) return {*text};
  const Estimate* value = estimate_in(cell);
  if (value == nullptr) return {""};
  const std::optional<bool> inside = value->in_band();
  return {with_spread(*value, column), !inside   ? HtmlTable::Cell::Kind::plain
                                       : *inside ? HtmlTable::Cell::Kind::inside
                                                 : HtmlTable::Cell::Kind::outside};
}

std::string html_of(const ExperimentTable& table, int number) {
  validate(table);
  HtmlTable page;
  page.caption = fmt::format("Table {}. {}", number, table.title);
  page.columns.push_back({table.row_title, HtmlTable::Align::left, ""});
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    page.columns.push_back({table.columns[k].title, HtmlTable::Align::right, ""});
    if (any_published(table, k)) page.columns.push_back({"paper", HtmlTable::Align::right, "as published"});
  }
  for (const ExperimentTable::Row& row : table.rows) {
    std::vector<HtmlTable::Cell> cells{{row.name}};
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      cells.push_back(html_cell(row.cells[k], table.columns[k]));
      if (!any_published(table, k)) continue;
      const Estimate* value = estimate_in(row.cells[k]);
      const bool known = value != nullptr && value->published;
      cells.push_back(
          {known ? readable(*value->published, table.columns[k].decimals) : "", HtmlTable::Cell::Kind::reference});
    }
    page.rows.push_back(std::move(cells));
  }
  std::string note =
      "Mean ± standard deviation of single runs; differences with their 95 % interval. ✓ ✗: inside or "
      "outside of the band that counts as reproducing the paper.";
  if (!table.note.empty()) note = table.note + " " + note;
  return html_figure(html(page), note);
}

std::string html_of(const ExperimentFigure& figure, int number) {
  std::string plots = figure.plots.size() > 1 ? "<div class=\"two\">\n" : "<div>\n";
  for (const ExperimentFigure::Plot& plot : figure.plots)
    plots += std::visit([](const auto& chosen) { return svg_plot(chosen); }, plot);
  const std::string note = figure.note.empty() ? "" : ". " + figure.note;
  return html_figure(plots + "</div>\n", fmt::format("Figure {}. {}{}", number, figure.title, note));
}

}  // namespace

ExperimentReport only(const ExperimentReport& report, ExperimentContent content) {
  ExperimentReport part = report;
  std::erase_if(part.parts, [content](const ExperimentReport::Part& each) {
    return std::visit([](const auto& p) { return p.content; }, each) != content;
  });
  return part;
}

std::string html_body(const ExperimentReport& report) {
  std::string body = fmt::format("<style>\n{}</style>\n<article class=\"report\">\n", report_style());
  body += fmt::format("<p class=\"eyebrow\">Vantage · experiment</p>\n<h1>{}</h1>\n", escape_markup(report.title));
  for (const std::string& paragraph : report.text) body += fmt::format("<p>{}</p>\n", escape_markup(paragraph));
  int tables = 0, figures = 0;
  for (const ExperimentReport::Part& part : report.parts) {
    if (const auto* table = std::get_if<ExperimentTable>(&part)) body += html_of(*table, ++tables);
    if (const auto* figure = std::get_if<ExperimentFigure>(&part)) body += html_of(*figure, ++figures);
  }
  return body + fmt::format("<footer>{}</footer>\n</article>\n", escape_markup(report.program));
}

std::string html(const ExperimentReport& report) { return html_page(report.title + " – Vantage", html_body(report)); }

}  // namespace vantage
