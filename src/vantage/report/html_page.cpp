#include "vantage/report/html_page.hpp"

#include <fmt/format.h>

#include "vantage/core/error.hpp"
#include "vantage/report/svg.hpp"

namespace vantage {
namespace {

constexpr std::string_view page_style = R"css(
.report{background:var(--paper);color:var(--ink);font:16px/1.55 Charter,'Bitstream Charter','Iowan Old Style',Georgia,Cambria,'Times New Roman',serif;max-width:1080px;margin:0 auto;padding:40px 28px 64px;box-sizing:border-box}
.report *{box-sizing:border-box}
.report h1,.report h2,.report figcaption,.report table,.report .tiles,.report .eyebrow,.report footer,.report .legend{font-family:system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,'DejaVu Sans',sans-serif}
.report .eyebrow{color:var(--muted);font-size:13px;letter-spacing:.09em;text-transform:uppercase;margin:0}
.report h1{font-size:34px;line-height:1.15;margin:2px 0 10px;letter-spacing:-.01em;overflow-wrap:anywhere}
.report h2{font-size:19px;margin:44px 0 8px;padding-top:14px;border-top:1px solid var(--rule)}
.report p{margin:8px 0;max-width:70ch}
.report .lede{font-size:19px;line-height:1.45}
.report .tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(130px,1fr));gap:10px;margin:22px 0;padding:0}
.report .tiles div{background:var(--card);border:1px solid var(--rule);border-radius:6px;padding:10px 12px}
.report .tiles dt{color:var(--muted);font-size:12px}
.report .tiles dd{margin:0;font-size:23px;font-weight:600;font-variant-numeric:tabular-nums;white-space:nowrap}
.report .tiles dd small{font-size:13px;font-weight:400;color:var(--muted)}
.report figure{margin:18px 0}
.report figcaption{color:var(--muted);font-size:13px;line-height:1.45;margin-top:8px;max-width:85ch}
.report figcaption b{color:var(--ink)}
.report img{display:block;width:100%;height:auto;border-radius:6px;border:1px solid var(--rule)}
.report .three,.report .two{display:grid;gap:10px}
.report .three{grid-template-columns:repeat(auto-fit,minmax(min(100%,300px),1fr))}
.report .four{display:grid;gap:14px;grid-template-columns:repeat(auto-fit,minmax(220px,1fr))}
.report .two{grid-template-columns:repeat(auto-fit,minmax(min(100%,400px),1fr));gap:18px}
.report .three>div>span{display:block;font:12px system-ui,sans-serif;color:var(--muted);margin-top:4px}
.report .plot{display:block;margin:0 auto}
.report .wide{overflow-x:auto}
.report table{border-collapse:collapse;font-size:13px;font-variant-numeric:tabular-nums;width:100%}
.report caption{text-align:left;color:var(--muted);padding:0 0 8px;line-height:1.45}
.report caption b{color:var(--ink)}
.report th{font-weight:600;border-bottom:1.5px solid var(--ink);border-top:1.5px solid var(--ink);padding:5px 7px;vertical-align:bottom;white-space:nowrap}
.report td{border-bottom:1px solid var(--faint);padding:5px 7px;vertical-align:top}
.report tbody tr:last-child td{border-bottom:1.5px solid var(--ink)}
.report .l{text-align:left}.report .r{text-align:right;white-space:nowrap}
.report .reference{color:var(--muted);font-style:italic}
.report .inside::before{content:'✓ ';color:var(--s2)}.report .outside::before{content:'✗ ';color:var(--s1)}
.report footer{color:var(--muted);font-size:12px;margin-top:48px;padding-top:12px;border-top:1px solid var(--rule)}
.report .swatch-key{display:inline-block;width:11px;height:11px;border-radius:2px;margin:0 4px 0 10px;vertical-align:-1px;border:1px solid var(--rule)}
@media (max-width:600px){.report{padding:22px 14px 40px;font-size:15px}.report h1{font-size:27px}.report .lede{font-size:17px}}
@media print{.report{max-width:none;padding:0;font-size:10.5pt}.report figure,.report tr{break-inside:avoid}.report h2{break-after:avoid}.report .three{grid-template-columns:repeat(3,1fr)}.report .two{grid-template-columns:repeat(2,1fr)}.report .wide{overflow:visible}.report table{font-size:8pt}}
)css";

std::string_view align_class(HtmlTable::Align align) { return align == HtmlTable::Align::left ? "l" : "r"; }

std::string_view kind_class(HtmlTable::Cell::Kind kind) {
  switch (kind) {
    case HtmlTable::Cell::Kind::reference:
      return " reference";
    case HtmlTable::Cell::Kind::inside:
      return " inside";
    case HtmlTable::Cell::Kind::outside:
      return " outside";
    case HtmlTable::Cell::Kind::plain:
      break;
  }
  return "";
}

}  // namespace

std::string html(const HtmlTable& table) {
  std::string text = "<div class=\"wide\"><table>\n";
  if (!table.caption.empty()) text += fmt::format("<caption>{}</caption>\n", escape_markup(table.caption));
  text += "<thead><tr>";
  for (const HtmlTable::Column& column : table.columns)
    text += fmt::format("<th scope=\"col\" class=\"{}\"{}>{}</th>", align_class(column.align),
                        column.hint.empty() ? "" : fmt::format(" title=\"{}\"", escape_markup(column.hint)),
                        escape_markup(column.title));
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    require(row.size() == table.columns.size(), "table '", table.caption, "': a row has ", row.size(),
            " cells: must have ", table.columns.size());
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      text += fmt::format("<td class=\"{}{}\">{}</td>", align_class(table.columns[i].align), kind_class(row[i].kind),
                          escape_markup(row[i].text));
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string html_figure(std::string_view content, std::string_view caption) {
  return fmt::format("<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n", content, escape_markup(caption));
}

std::string report_style() { return plot_style() + std::string(page_style); }

std::string html_page(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{}</title>\n"
      "<style>:root{{color-scheme:light dark}}body{{margin:0}}"
      "@media screen and (prefers-color-scheme:dark){{body{{background:#15181c}}}}</style>\n"
      "</head>\n<body>\n{}</body>\n</html>\n",
      escape_markup(title), body);
}

}  // namespace vantage
