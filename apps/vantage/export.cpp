#include <fmt/core.h>

#include <memory>

#include "commands.hpp"
#include "vantage/core/error.hpp"
#include "vantage/formats/map_file.hpp"
#include "vantage/formats/octomap_file.hpp"

namespace vantage::app {

void add_export(CLI::App& program) {
  struct ExportRequest {
    std::string map, out;
  };
  auto request = std::make_shared<ExportRequest>();
  CLI::App* command = program.add_subcommand("export", "Write a map for other programs: OctoMap .bt");
  command->add_option("map", request->map, "map file, NAME.nrrd with NAME.ply beside it")->required();
  command->add_option("out", request->out, "file to write, NAME.bt")->required();
  command->callback([request] {
    require(request->out.ends_with(".bt"), "out = '", request->out, "': must end in .bt (OctoMap)");
    write_octomap(read_map(request->map), request->out);
    fmt::print("wrote {}\n", request->out);
  });
}

}  // namespace vantage::app
