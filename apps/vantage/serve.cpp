#include <fmt/core.h>

#include <memory>
#include <string>

#include "commands.hpp"
#include "interrupt.hpp"
#include "notes.hpp"
#include "page_server.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/plain_text.hpp"
#include "vantage/server/admission.hpp"
#include "vantage/server/folder_watch.hpp"
#include "vantage/server/session_service.hpp"

namespace vantage::app {
namespace {

struct ServeRequest {
  std::string folder;
  PageServerOptions server;
};

void serve_session(const ServeRequest& request) {
  require(request.server.token.has_value() || is_loopback(request.server.host),
          "token: must be given where --bind = ", request.server.host,
          " lets other machines in: 16 or more letters and digits, in --token or the environment's VANTAGE_TOKEN");
  LiveRun run;
  SessionService service(request.folder, run);
  const SessionStatus status = service.session().status();
  for (const std::string& each : status.dropped) print_note("vantage: {}\n", printable(each));
  for (const auto& [number, reason] : status.left_out)
    print_note("vantage: left out scan {}, which is safe on disk: {}\n", number, printable(reason));
  const std::unique_ptr<HttpServer> server = page_server(request.server, run);
  service.add_routes(*server);
  catch_interrupts();
  start_and_tell(*server);
  wait_for_interrupt();
  service.stop();
}

void serve(const ServeRequest& request) {
  (void)http_options(request.server);  // what is wrong with them is said before anything is opened
  if (SessionFolder::is_session(request.folder)) {
    serve_session(request);
    return;
  }
  LiveRun run;
  FolderWatch watch(request.folder, run);
  watch.look();
  const std::unique_ptr<HttpServer> server = page_server(request.server, run);
  catch_interrupts();
  start_and_tell(*server);
  wait_for_interrupt([&] { watch.look(); });
}

}  // namespace

void add_serve(CLI::App& program) {
  auto request = std::make_shared<ServeRequest>();
  CLI::App* command = program.add_subcommand(
      "serve", "Show a reconstruction or experiment in the browser, or give a session to robots and browsers");
  command->add_option("folder", request->folder, "output folder of a reconstruction or experiment, or a session")
      ->required();
  command->add_option("--port", request->server.port, "port of the page; 0: any free one")->capture_default_str();
  add_page_server_options(*command, request->server);
  command->callback([request] { serve(*request); });
}

}  // namespace vantage::app
