#include <memory>
#include <string>

#include "commands.hpp"
#include "interrupt.hpp"
#include "page_server.hpp"
#include "vantage/server/folder_watch.hpp"

namespace vantage::app {
namespace {

struct Request {
  std::string folder;
  PageServerOptions server;
};

void serve(const Request& request) {
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
  auto request = std::make_shared<Request>();
  CLI::App* command =
      program.add_subcommand("serve", "Show a reconstruction in the browser, while it goes on or afterwards");
  command->add_option("folder", request->folder, "output folder of a reconstruction")->required();
  command->add_option("--port", request->server.port, "port of the page; 0: any free one")->capture_default_str();
  add_page_server_options(*command, request->server);
  command->callback([request] { serve(*request); });
}

}  // namespace vantage::app
