#include "vantage/report/svg.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vantage {

std::string escape_markup(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char letter : text) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += static_cast<unsigned char>(letter) < 0x20 && letter != '\n' && letter != '\t' ? '?' : letter;
    }
  }
  return result;
}

std::string readable(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool negative = value < 0 && digits.find_first_not_of("0.") != std::string::npos;
  const std::size_t point = std::min(digits.find('.'), digits.size());
  if (point >= 5)  // as typesetters do it: 1234, but 12 345
    for (std::size_t place = point; place > 3;) digits.insert(place -= 3, "\u2009");
  return (negative ? "−" : "") + digits;
}

namespace svg {

std::string number(double value) {
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string text(double x, double y, std::string_view content, Anchor anchor, std::string_view css_class) {
  if (content.empty()) return "";
  constexpr std::string_view names[] = {"start", "middle", "end"};
  return fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\"{}>{}</text>\n", number(x), number(y),
                     names[static_cast<std::size_t>(anchor)],
                     css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class), escape_markup(content));
}

std::string line(double x1, double y1, double x2, double y2, std::string_view css_class) {
  return fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" class=\"{}\"/>\n", number(x1), number(y1),
                     number(x2), number(y2), css_class);
}

std::string mark(double x, double y, std::size_t k) {
  const std::string css_class = fmt::format("mark f{}", k % series_styles);
  const auto polygon = [&](std::string_view moves) {
    return fmt::format("<path class=\"{}\" d=\"M{} {}{}z\"/>\n", css_class, number(x), number(y), moves);
  };
  switch (k % 5) {
    case 0:
      return fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"3\"/>\n", css_class, number(x), number(y));
    case 1:
      return polygon("m-2.8-2.8h5.6v5.6h-5.6");
    case 2:
      return polygon("m0-3.6 3.6 6.2h-7.2");
    case 3:
      return polygon("m0-3.9 3.9 3.9-3.9 3.9-3.9-3.9");
    default:
      return polygon("m-1.2-3.6h2.4v2.4h2.4v2.4h-2.4v2.4h-2.4v-2.4h-2.4v-2.4h2.4");
  }
}

double text_width(std::string_view content) {
  double letters = 0;
  for (const char letter : content) letters += (static_cast<unsigned char>(letter) & 0xC0U) == 0x80U ? 0 : 1;
  return 6.3 * letters;
}

std::string picture(double width, double height, std::string_view title, std::string_view content) {
  return fmt::format(
      "<svg class=\"plot\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "role=\"img\">\n<title>{2}</title>\n{3}</svg>\n",
      number(width), number(height), escape_markup(title), content);
}

}  // namespace svg

std::string plot_style() {
  const std::string light =
      "--paper:#fff;--ink:#1b1f24;--muted:#5b6470;--rule:#c9ced6;--faint:#eceff3;--card:#fbfbfa;"
      "--s0:#0072b2;--s1:#d55e00;--s2:#009e73;--s3:#b5548a;--s4:#b87f00;--s5:#3a9bd9;--s6:#1b1f24";
  const std::string dark =
      "--paper:#15181c;--ink:#e8eaed;--muted:#a4acb6;--rule:#4a515b;--faint:#262b31;--card:#1c2025;"
      "--s0:#56b4e9;--s1:#f08b4b;--s2:#2fc79a;--s3:#e29bc3;--s4:#e8b33f;--s5:#8fd0ff;--s6:#e8eaed";
  std::string css = fmt::format(
      ".plot,.report{{{0}}}\n"
      "@media screen and (prefers-color-scheme:dark){{.plot,.report{{{1}}}}}\n"
      ".plot{{font:12px/1.2 system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,'DejaVu Sans',sans-serif;"
      "max-width:100%;height:auto;font-variant-numeric:tabular-nums}}\n"
      ".plot text{{fill:var(--ink)}}.plot .tick,.plot .note{{fill:var(--muted);font-size:11px}}"
      ".plot .name{{font-weight:600}}.plot .none{{fill:var(--muted);font-style:italic}}\n"
      ".plot .axis{{stroke:var(--muted);stroke-width:1}}.plot .grid{{stroke:var(--faint);stroke-width:1}}"
      ".plot .frame,.plot .swatch{{stroke:var(--rule)}}.plot .frame{{fill:none}}\n"
      ".plot .curve{{fill:none;stroke-width:2;stroke-linejoin:round;stroke-linecap:round}}.plot .band{{opacity:.18}}"
      ".plot .bar{{stroke:var(--paper);stroke-width:.75}}.plot .whisker{{stroke:var(--ink);stroke-width:1.2}}"
      ".plot .mark{{stroke:var(--paper);stroke-width:.75}}"
      ".plot .paper{{fill:none;stroke:var(--ink);stroke-width:1.6}}.plot "
      ".edge{{stroke:var(--paper);stroke-width:.4}}\n",
      light, dark);
  constexpr std::string_view dashes[] = {"none", "7 4", "2 4", "10 4 2 4", "4 3", "12 3", "1 3"};
  for (std::size_t k = 0; k < series_styles; ++k)
    css += fmt::format(".plot .c{0}{{stroke:var(--s{0});stroke-dasharray:{1}}}.plot .f{0}{{fill:var(--s{0})}}", k,
                       dashes[k]);
  return css + "\n";
}

std::string standalone_svg(std::string_view plot) {
  constexpr std::string_view opening = "<svg ";
  std::string file(plot);
  const std::size_t start = file.find(opening);
  if (start == std::string::npos) return file;
  const std::size_t inside = file.find('>', start);
  file.insert(inside + 1, "\n<style>" + plot_style() + ".plot{background:var(--paper)}</style>");
  file.insert(start + opening.size(), "xmlns=\"http://www.w3.org/2000/svg\" ");
  return file;
}

}  // namespace vantage
