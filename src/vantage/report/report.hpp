#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "vantage/runs/run_document.hpp"

namespace vantage {

/// The page of viewer/ with empty data, as it is embedded in the program.
[[nodiscard]] std::string_view viewer_page();

/// `page` with a document and the pictures for readers without JavaScript written into their places. Throws Error where
/// the page does not have exactly one of each place.
[[nodiscard]] std::string fill_page(std::string_view page, const nlohmann::ordered_json& document,
                                    std::string_view static_html);

/// The document in a page that fill_page made, nothing where it holds none. Throws InputError, which names `what`,
/// where the page is cut off.
[[nodiscard]] std::optional<nlohmann::ordered_json> document_of_page(std::string_view page, const std::string& what);

/// report.html of a run: one file that opens from disk and asks for nothing else.
[[nodiscard]] std::string report_html(const RunData& run);

}  // namespace vantage
