#include "vantage/report/report.hpp"

#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view data_place = R"(<script type="application/json" id="vantage-data"></script>)";
constexpr std::string_view static_place = "<!--vantage-static-->";

}  // namespace

std::string fill_page(std::string_view page, const Json& document, std::string_view static_html) {
  std::string result(page);
  const auto fill = [&result](std::string_view place, std::string_view text) {
    const std::size_t at = result.find(place);
    if (at == std::string::npos || result.find(place, at + 1) != std::string::npos) {
      throw Error(concat("the viewer's page must have ", place, " exactly once"));
    }
    result.replace(at, place.size(), text);
  };
  // File names and messages may hold any bytes; in a script element no `<` may stand.
  std::string json = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string escaped;
  escaped.reserve(json.size());
  for (const char c : json) c == '<' ? escaped += "\\u003c" : escaped += c;
  constexpr std::string_view end_tag = "</script>";
  fill(static_place, static_html);
  fill(data_place, concat(data_place.substr(0, data_place.size() - end_tag.size()), escaped, end_tag));
  return result;
}

std::optional<Json> document_of_page(std::string_view page, const std::string& what) {
  const std::string_view start = data_place.substr(0, data_place.find("</script>"));
  const std::size_t at = page.find(start);
  if (at == std::string_view::npos) return std::nullopt;
  const std::size_t begin = at + start.size();
  const std::size_t end = page.find("</script>", begin);
  require(end != std::string_view::npos, what, ": the file is cut off within its data");
  const std::string_view text = page.substr(begin, end - begin);
  if (text.empty()) return std::nullopt;
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    throw InputError(concat(what, ": its data are no JSON: ", error.what()));
  }
}

std::string report_html(const RunData& run) { return fill_page(viewer_page(), run_json(run), run.static_html); }

}  // namespace vantage
