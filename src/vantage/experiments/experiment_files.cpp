#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/experiments/experiment_report.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

/// A field of a CSV file (RFC 4180): in quotes where it has to be.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted.append(letter == '"' ? 2 : 1, letter);
  return quoted + '"';
}

std::string field(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string field(const std::optional<double>& value) { return value ? field(*value) : ""; }

/// An estimate as its fields, in the order of `estimate_columns`.
constexpr const char* estimate_columns[] = {"mean",  "sd",       "runs",      "low",    "high",
                                            "paper", "band_low", "band_high", "in_band"};
std::string fields(const Estimate& value) {
  const std::optional<bool> inside = value.in_band();
  return fmt::format("{},{},{},{},{},{},{},{},{}", field(value.mean), field(value.sd), value.runs, field(value.low),
                     field(value.high), field(value.published), field(value.band_low), field(value.band_high),
                     inside ? (*inside ? "1" : "0") : "");
}

bool has_estimates(const ExperimentTable& table, std::size_t column) {
  return std::any_of(table.rows.begin(), table.rows.end(), [&](const ExperimentTable::Row& row) {
    return std::holds_alternative<Estimate>(row.cells.at(column));
  });
}

/// Writes the values of a figure's plots row by row.
class FigureRows {
 public:
  std::string text = "plot,series,x,y,value,low,high\n";

  void operator()(const LineChart& chart) {
    for (const LineSeries& series : chart.series)
      for (std::size_t i = 0; i < series.y.size(); ++i)
        add(chart.title, series.name, field(series.x[i]), "", series.y[i], at(series.low, i), at(series.high, i));
    for (const PaperMark& mark : chart.paper) add(chart.title, "paper", field(mark.x), "", mark.y, NAN, NAN);
  }
  void operator()(const BarChart& chart) {
    for (const BarSeries& series : chart.series)
      for (std::size_t i = 0; i < series.value.size(); ++i)
        add(chart.title, series.name, field(chart.categories[i]), "", series.value[i], at(series.low, i),
            at(series.high, i));
    for (const BarSeries& series : chart.series)
      for (std::size_t i = 0; i < series.paper.size(); ++i)
        if (std::isfinite(series.paper[i]))
          add(chart.title, fmt::format("paper {}", series.name), field(chart.categories[i]), "", series.paper[i], NAN,
              NAN);
  }
  void operator()(const HeatMap& map) { add(map.title, map.grid); }
  void operator()(const SurfacePlot& plot) { add(plot.title, plot.grid); }
  void operator()(const SphereMap& map) {
    for (std::size_t i = 0; i < map.values.size(); ++i) {
      const Vec3 d = map.directions[i].normalized();
      add(map.title, map.value_label, field(degrees(std::atan2(d.x(), -d.y()))),
          field(degrees(std::asin(std::clamp(d.z(), -1.0, 1.0)))), map.values[i], NAN, NAN);
    }
  }

 private:
  static double at(const std::vector<double>& values, std::size_t i) { return i < values.size() ? values[i] : NAN; }

  void add(const std::string& plot, const GridValues& grid) {
    grid.validate();
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column) {
        const double x = grid.x_low + (grid.x_high - grid.x_low) * (column + 0.5) / grid.columns;
        const double y = grid.y_low + (grid.y_high - grid.y_low) * (row + 0.5) / grid.rows;
        add(plot, grid.value_label, field(x), field(y),
            grid.values[static_cast<std::size_t>(row * grid.columns + column)], NAN, NAN);
      }
  }
  void add(const std::string& plot, const std::string& series, const std::string& x, const std::string& y, double value,
           double low, double high) {
    text +=
        fmt::format("{},{},{},{},{},{},{}\n", field(plot), field(series), x, y, field(value), field(low), field(high));
  }
};

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

Json estimate_json(const Estimate& value) {
  const auto or_null = [](const auto& optional) { return optional ? Json(*optional) : Json(nullptr); };
  return {{"mean", number(value.mean)},
          {"sd", number(value.sd)},
          {"runs", value.runs},
          {"low", number(value.low)},
          {"high", number(value.high)},
          {"paper", or_null(value.published)},
          {"band_low", or_null(value.band_low)},
          {"band_high", or_null(value.band_high)},
          {"in_band", or_null(value.in_band())}};
}

Json table_json(const ExperimentTable& table) {
  Json columns = {table.row_title}, paper_columns = Json::array();
  std::vector<bool> wide;  // columns that take a mean, a standard deviation or an interval, and the paper's value
  using Kind = ExperimentTable::Column::Kind;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    columns.push_back(table.columns[k].title);
    wide.push_back(has_estimates(table, k));
    if (!wide.back()) continue;
    columns.push_back(table.columns[k].kind == Kind::difference ? "95 % interval" : "± sd");
    paper_columns.push_back(columns.size());
    columns.push_back("paper");
  }
  Json rows = Json::array(), estimates = Json::array();
  for (const ExperimentTable::Row& row : table.rows) {
    Json cells = {row.name}, numbers_of_row = Json::array();
    for (std::size_t k = 0; k < row.cells.size(); ++k) {
      const Estimate* value = std::get_if<Estimate>(&row.cells[k]);
      const std::string* text = std::get_if<std::string>(&row.cells[k]);
      cells.push_back(value != nullptr ? number(value->mean) : text != nullptr ? Json(*text) : Json(nullptr));
      numbers_of_row.push_back(value != nullptr ? estimate_json(*value) : Json(nullptr));
      if (!wide[k]) continue;
      if (value == nullptr) {
        cells.push_back(nullptr);
      } else if (table.columns[k].kind == Kind::difference) {
        const int decimals = table.columns[k].decimals;
        cells.push_back(concat("[", readable(value->low, decimals), ", ", readable(value->high, decimals), "]"));
      } else {
        cells.push_back(number(value->sd));
      }
      cells.push_back(value != nullptr && value->published ? number(*value->published) : Json(nullptr));
    }
    rows.push_back(std::move(cells));
    estimates.push_back(std::move(numbers_of_row));
  }
  Json measures = Json::array();
  for (const ExperimentTable::Column& column : table.columns)
    measures.push_back({{"title", column.title},
                        {"decimals", column.decimals},
                        {"difference", column.kind == ExperimentTable::Column::Kind::difference}});
  return {{"name", table.name}, {"title", table.title},           {"columns", columns},     {"rows", rows},
          {"note", table.note}, {"paper_columns", paper_columns}, {"estimates", estimates}, {"measures", measures}};
}

Json chart_json(const ExperimentFigure& figure, const LineChart& chart) {
  Json series = Json::array();
  for (const LineSeries& line : chart.series) {
    Json entry{{"name", line.name}, {"x", numbers(line.x)}, {"y", numbers(line.y)}};
    if (!line.low.empty()) {
      entry["low"] = numbers(line.low);
      entry["high"] = numbers(line.high);
    }
    series.push_back(std::move(entry));
  }
  if (!chart.paper.empty()) {
    std::vector<double> x, y;
    for (const PaperMark& mark : chart.paper) {
      x.push_back(mark.x);
      y.push_back(mark.y);
    }
    series.push_back({{"name", "paper"}, {"x", numbers(x)}, {"y", numbers(y)}, {"paper", true}});
  }
  return {{"name", figure.name},      {"title", chart.title},     {"kind", "lines"},
          {"x_label", chart.x.label}, {"y_label", chart.y.label}, {"series", series}};
}

Json chart_json(const ExperimentFigure& figure, const BarChart& chart) {
  Json series = Json::array();
  for (const BarSeries& bars : chart.series) {
    Json entry{{"name", bars.name}, {"y", numbers(bars.value)}};
    if (!bars.low.empty()) {
      entry["low"] = numbers(bars.low);
      entry["high"] = numbers(bars.high);
    }
    series.push_back(std::move(entry));
    if (!bars.paper.empty())
      series.push_back({{"name", fmt::format("paper {}", bars.name)}, {"y", numbers(bars.paper)}, {"paper", true}});
  }
  return {{"name", figure.name},      {"title", chart.title},
          {"kind", "bars"},           {"x_label", chart.category_label},
          {"y_label", chart.y.label}, {"categories", chart.categories},
          {"series", series}};
}

Json grid_json(const ExperimentFigure& figure, const std::string& title, const std::string& kind,
               const GridValues& grid) {
  grid.validate();
  return {{"name", figure.name},
          {"title", title},
          {"kind", kind},
          {"x_label", grid.x_label},
          {"y_label", grid.y_label},
          {"value_label", grid.value_label},
          {"x", {grid.x_low, grid.x_high}},
          {"y", {grid.y_low, grid.y_high}},
          {"columns", grid.columns},
          {"rows", grid.rows},
          {"values", numbers(grid.values)}};
}

Json chart_json(const ExperimentFigure& figure, const HeatMap& map) {
  return grid_json(figure, map.title, "heat", map.grid);
}

Json chart_json(const ExperimentFigure& figure, const SurfacePlot& plot) {
  return grid_json(figure, plot.title, "surface", plot.grid);
}

Json chart_json(const ExperimentFigure& figure, const SphereMap& map) {
  Json directions = Json::array();
  for (const Vec3& direction : map.directions) {
    const Vec3 unit = direction.normalized();
    directions.push_back({unit.x(), unit.y(), unit.z()});
  }
  return {{"name", figure.name},
          {"title", map.title},
          {"kind", "sphere"},
          {"value_label", map.value_label},
          {"directions", directions},
          {"values", numbers(map.values)},
          {"chosen", map.chosen ? Json(*map.chosen) : Json(nullptr)}};
}

}  // namespace

std::string csv(const ExperimentTable& table) {
  std::string text = field(table.row_title);
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (!has_estimates(table, k)) {
      text += fmt::format(",{}", field(table.columns[k].title));
      continue;
    }
    for (const char* part : estimate_columns)
      text += fmt::format(",{}", field(fmt::format("{}: {}", table.columns[k].title, part)));
  }
  text += '\n';
  for (const ExperimentTable::Row& row : table.rows) {
    text += field(row.name);
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      const ExperimentTable::Cell& cell = row.cells.at(k);
      const std::string empty = has_estimates(table, k) ? std::string(std::size(estimate_columns) - 1, ',') : "";
      if (const Estimate* value = std::get_if<Estimate>(&cell))
        text += fmt::format(",{}", fields(*value));
      else if (const std::string* words = std::get_if<std::string>(&cell))
        text += fmt::format(",{}{}", field(*words), empty);
      else
        text += fmt::format(",{}", empty);
    }
    text += '\n';
  }
  return text;
}

std::string csv(const ExperimentFigure& figure) {
  FigureRows rows;
  for (const ExperimentFigure::Plot& plot : figure.plots) std::visit(rows, plot);
  return rows.text;
}

Json json(const ExperimentReport& report) {
  Json figures = Json::array(), tables = Json::array();
  for (const ExperimentReport::Part& part : report.parts) {
    if (const auto* table = std::get_if<ExperimentTable>(&part)) tables.push_back(table_json(*table));
    if (const auto* figure = std::get_if<ExperimentFigure>(&part))
      for (const ExperimentFigure::Plot& plot : figure->plots)
        figures.push_back(std::visit([figure](const auto& chosen) { return chart_json(*figure, chosen); }, plot));
  }
  return {{"format", "vantage-experiment"},
          {"version", 1},
          {"title", report.title},
          {"program", report.program},
          {"text", report.text},
          {"figures", figures},
          {"tables", tables}};
}

}  // namespace vantage
