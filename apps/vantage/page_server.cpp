#include "page_server.hpp"

#include <fmt/core.h>

#include <chrono>
#include <thread>

#include "interrupt.hpp"
#include "notes.hpp"
#include "vantage/core/error.hpp"
#include "vantage/server/admission.hpp"
#include "vantage/server/random_name.hpp"

#include "vantage/core/number_text.hpp"

namespace vantage::app {

int port_from_text(const std::string& text, const std::string& option) {
  const std::optional<int> port = number_from<int>(text);
  require(port && *port >= 0 && *port <= 65535, option, " = ", text,
          ": must be a port, 1 to 65535, or 0 for any free one");
  return port.value_or(0);
}

void add_page_server_options(CLI::App& command, PageServerOptions& options) {
  command
      .add_option("--host,--bind", options.host,
                  "address that the page is served at; 0.0.0.0 lets other machines in, who then need the token")
      ->capture_default_str();
  command
      .add_option("--token", options.token,
                  "what browsers and robots must know to come in (16 or more letters and digits); made up where a page "
                  "needs it")
      ->envname("VANTAGE_TOKEN");
}

HttpServerOptions http_options(const PageServerOptions& options) {
  // Where a script's variable with the token is not set, the page would be open to everybody.
  require(!options.token || !options.token->empty(), "token: is empty; must have ", shortest_token,
          " or more letters and digits, or not be given");
  HttpServerOptions http;
  http.host = options.host;
  http.port = options.port;
  http.token = options.token.value_or("");
  if (http.token.empty() && is_address(http.host) && !is_loopback(http.host)) http.token = random_name();
  http.validate();
  return http;
}

std::unique_ptr<HttpServer> page_server(const PageServerOptions& options, LiveRun& run) {
  auto server = std::make_unique<HttpServer>(http_options(options));
  add_page(*server, run);
  return server;
}

void start_and_tell(HttpServer& server) {
  server.start();
  print_note("the page is at {}\n", server.url());
}

void wait_for_interrupt(const std::function<void()>& meanwhile) {
  print_note("Ctrl-C ends it\n");
  while (!was_interrupted()) {
    meanwhile();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

}  // namespace vantage::app
