#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// A table for people. Cells are plain text; they are escaped when written.
struct HtmlTable {
  enum class Align { left, right };
  struct Column {
    std::string title;
    Align align = Align::right;
    std::string hint;  // shown when the pointer rests on the title
  };
  struct Cell {
    std::string text;
    /// How it is set: as it is, paler (a published value), or with a sign that it is in or out of its band.
    enum class Kind { plain, reference, inside, outside } kind = Kind::plain;
  };
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
};

/// Throws InputError where a row has another length than the columns.
[[nodiscard]] std::string html(const HtmlTable& table);

/// <figure> around pictures and plots (HTML), with a caption (text).
[[nodiscard]] std::string html_figure(std::string_view content, std::string_view caption);

/// The style of report pages and their plots. Everything is below the classes `report` and `plot`.
[[nodiscard]] std::string report_style();

/// A whole page that needs nothing else: no script, no other file. `title` is text; `body` is HTML.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view body);

}  // namespace vantage
