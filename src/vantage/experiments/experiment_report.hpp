#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

#include "vantage/experiments/estimate.hpp"
#include "vantage/report/svg_map.hpp"
#include "vantage/report/svg_plot.hpp"

namespace vantage {

/// What a part of a report holds. Times differ whenever the experiment is repeated, all else does not.
enum class ExperimentContent { results, times };

/// A table with a row per object (or method) and a column per measure.
struct ExperimentTable {
  struct Column {
    std::string title;  // with its unit
    int decimals = 2;   // for people; files get every digit
    /// A difference is shown with its sign and its interval, everything else as mean and standard deviation.
    enum class Kind { measure, difference } kind = Kind::measure;
  };
  /// Empty where there is nothing, a text, or a number with its spread.
  using Cell = std::variant<std::monostate, std::string, Estimate>;

  std::string name;   // of files: table1
  std::string title;  // for people
  std::string note;   // below the table; may be empty
  std::string row_title = "object";
  std::vector<Column> columns;
  struct Row {
    std::string name;
    std::vector<Cell> cells;  // as many as columns
  };
  std::vector<Row> rows;
  ExperimentContent content = ExperimentContent::results;
};

/// A figure of one or several plots.
struct ExperimentFigure {
  using Plot = std::variant<LineChart, BarChart, HeatMap, SurfacePlot, SphereMap>;
  std::string name;   // of files: figure10
  std::string title;  // for people
  std::string note;   // in the caption; may be empty
  std::vector<Plot> plots;
  ExperimentContent content = ExperimentContent::results;
};

/// What an experiment found, in the order in which it is to be read.
struct ExperimentReport {
  using Part = std::variant<ExperimentTable, ExperimentFigure>;
  std::string title;
  std::string program;            // name and version
  std::vector<std::string> text;  // paragraphs before the parts
  std::vector<Part> parts;
};

/// The parts of the report with that content.
[[nodiscard]] ExperimentReport only(const ExperimentReport& report, ExperimentContent content);

/// The report as one page without script and without other files: tables with the paper's number beside ours, plots
/// with error bands and the paper's values drawn in.
[[nodiscard]] std::string html(const ExperimentReport& report);
/// The same without the page around it.
[[nodiscard]] std::string html_body(const ExperimentReport& report);

/// report.html of an experiment: the interactive page, with html_body() for readers without JavaScript.
[[nodiscard]] std::string experiment_page(const ExperimentReport& report);

/// RFC 4180: one row per row of the table. Where a column of the table holds estimates it takes the columns
/// "TITLE: mean", sd, runs, low, high, paper, band_low, band_high and in_band (1 or 0), else one column. Numbers
/// round-trip; what there is not is an empty field.
[[nodiscard]] std::string csv(const ExperimentTable& table);
/// One row per value: plot, series, x, y, value, low, high. Curves and bars have no y, bars have their category as x;
/// the paper's values are the series "paper". Maps over the plane have the cell's middle as x, y; maps over the sphere
/// the longitude (from -y towards +x) and latitude in degrees.
[[nodiscard]] std::string csv(const ExperimentFigure& figure);

/// The format "vantage-experiment" of docs/report-data.md, which viewer and programs can read; each table has its
/// estimates with all their numbers under `estimates`, rows by columns. NaN becomes null.
[[nodiscard]] nlohmann::ordered_json json(const ExperimentReport& report);

}  // namespace vantage
