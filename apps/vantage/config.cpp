#include <fmt/core.h>

#include <memory>

#include "commands.hpp"
#include "current_place.hpp"
#include "vantage/doctor/doctor.hpp"
#include "vantage/experiments/experiments.hpp"
#include "vantage/model/from_scans.hpp"
#include "vantage/model/surface_volume.hpp"
#include "vantage/options/options.hpp"
#include "vantage/options/reconstruct_options.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage::app {
namespace {

void print_section(const std::string& title, const std::vector<OptionField>& fields, bool markdown) {
  if (markdown) {
    fmt::print("## {}\n\n{}\n", title, options_as_markdown(fields));
  } else {
    fmt::print("# {}\n{}\n", title, options_as_yaml(fields));
  }
}

}  // namespace

void add_config(CLI::App& program) {
  auto markdown = std::make_shared<bool>(false);
  CLI::App* command = program.add_subcommand(
      "config", "Print every option with its default, unit and meaning, as a configuration file");
  command->add_flag("--markdown", *markdown, "as tables for the documentation");
  command->callback([markdown] {
    ReconstructOptions reconstruct;
    ScanPlanOptions plan;
    ScanFolderOptions folder;
    SurfaceOptions surface;
    if (*markdown) {
      fmt::print(
          "# Options\n\nMade by `vantage config --markdown`. Every option is a key of a file given with `--config`, "
          "and an option of the command line with `--` before it.\n\n");
    } else {
      fmt::print("{}\n", configuration_head());
    }
    print_section("vantage reconstruct", option_fields(reconstruct), *markdown);
    print_section("vantage plan, vantage session new: the scene", option_fields(plan), *markdown);
    print_section("vantage plan: reading scans", option_fields(folder), *markdown);
    print_section("vantage reconstruct and plan: the mesh", option_fields(surface), *markdown);
    CurrentPlace place;
    print_section("vantage evaluate: also those of reconstruct that decide how a view is planned", option_fields(place),
                  *markdown);
    DoctorOptions doctor;
    print_section("vantage doctor", option_fields(doctor), *markdown);
    ExperimentOptions experiment;
    print_section("vantage experiment", option_fields(experiment), *markdown);
    RobotDescription robot;
    print_section("A robot's file (--robot)", option_fields(robot), *markdown);
  });
}

}  // namespace vantage::app
