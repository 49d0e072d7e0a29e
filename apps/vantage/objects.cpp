#include <fmt/core.h>

#include "commands.hpp"
#include "vantage/simulation/objects.hpp"

namespace vantage::app {

void add_objects(CLI::App& program) {
  CLI::App* command = program.add_subcommand("objects", "List the built-in objects");
  command->callback([] {
    for (const std::string& name : object_names()) {
      const TriangleMesh mesh = make_object(name);
      fmt::print("{:<10} {:6} triangles, largest side {:.3f} m\n", name, mesh.triangles.size(), default_size(name));
    }
  });
}

}  // namespace vantage::app
