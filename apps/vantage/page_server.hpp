#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>

#include "vantage/server/http_server.hpp"
#include "vantage/server/live_run.hpp"

namespace vantage::app {

/// Where the page is served.
struct PageServerOptions {
  int port = 8350;  // 0: any free one
  std::string host = "127.0.0.1";
  std::optional<std::string> token;
};

/// Throws InputError, which names `option`, where the text is no port.
[[nodiscard]] int port_from_text(const std::string& text, const std::string& option);

/// `--host` and `--token`; the port belongs to the command.
void add_page_server_options(CLI::App& command, PageServerOptions& options);

/// What they mean. A host that other machines reach gets a token where none is given. Throws InputError naming the
/// option.
[[nodiscard]] HttpServerOptions http_options(const PageServerOptions& options);

/// A server with the page for `run`, not started yet, so that routes can be added.
[[nodiscard]] std::unique_ptr<HttpServer> page_server(const PageServerOptions& options, LiveRun& run);
/// Starts it and prints on standard error where to look.
void start_and_tell(HttpServer& server);
/// Calls `meanwhile` a few times a second until Ctrl-C (see catch_interrupts()).
void wait_for_interrupt(const std::function<void()>& meanwhile = [] {});

}  // namespace vantage::app
