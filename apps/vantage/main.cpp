#include <exception>
#include <iostream>

#include "commands.hpp"
#include "vantage/core/error.hpp"

namespace {

constexpr int failure = 1;
constexpr int misuse = 2;

int run(int argc, char** argv) {
  CLI::App program(
      "Vantage plans where a depth sensor should look next, so that an unknown object is scanned completely.");
  program.name("vantage");
  program.set_version_flag("--version", VANTAGE_VERSION);
  program.require_subcommand(1);
  program.failure_message(CLI::FailureMessage::help);
  vantage::app::add_reconstruct(program);
  vantage::app::add_plan(program);
  vantage::app::add_evaluate(program);
  vantage::app::add_config(program);
  vantage::app::add_export(program);
  vantage::app::add_objects(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& wanted) {  // --help and --version
    return program.exit(wanted);
  } catch (const CLI::ParseError& error) {
    std::cerr << "vantage: " << error.what() << "\nRun `vantage --help` for what there is.\n";
    return misuse;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const vantage::InputError& error) {
    std::cerr << "vantage: " << error.what() << '\n';
    return misuse;
  } catch (const std::exception& error) {
    std::cerr << "vantage: " << error.what() << '\n';
    return failure;
  }
}
