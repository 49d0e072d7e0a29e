#include "vantage/report/report.hpp"
#include "vantage/server/http_server.hpp"
#include "vantage/server/live_run.hpp"

namespace vantage {

namespace {

constexpr int most_browsers = 64;  // that load at a time

}  // namespace

void add_page(HttpServer& server, LiveRun& run) {
  // The element for the data stays empty: then the page asks for them.
  const auto page = std::make_shared<const std::string>(viewer_page());
  server.add(
      {.path = "/",
       .handle =
           [page](const HttpRequest&) { return HttpAnswer{.content_type = "text/html; charset=utf-8", .body = page}; },
       .at_once = most_browsers});
  server.add({.path = "/api/run",
              .handle =
                  [&run](const HttpRequest&) {
                    auto document = run.document();
                    if (!document) throw HttpError(503, "there is no scan yet");
                    return HttpAnswer{.body = std::move(document)};
                  },
              .at_once = most_browsers});
  server.add_events("/api/events", run);
}

}  // namespace vantage
