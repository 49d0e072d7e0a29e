#include <malloc.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "help.hpp"
#include "manual.hpp"
#include "notes.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/plain_text.hpp"
#include "vantage/options/options.hpp"

namespace {

constexpr int failure = 1;
constexpr int misuse = 2;

/// Frames take some MB each. As blocks of their own they go back to the system one by one, instead of leaving holes
/// among what is kept: a tenth less memory for long recordings.
void give_back_large_blocks() {
#ifdef M_MMAP_THRESHOLD
  constexpr int one_megabyte = 1 << 20;
  (void)mallopt(M_MMAP_THRESHOLD, one_megabyte);
#endif
}

/// What is wrong with the first word where it is no command; empty where it is one.
std::string unknown_command(const CLI::App& program, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  if (std::find(names.begin(), names.end(), argv[1]) != names.end()) return {};
  const std::string nearest = vantage::nearest_name(argv[1], names);
  return vantage::concat("'", argv[1], "' is no command", nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
}

/// "0.2.0 (commit 123456789abc)"; without the commit where it was not known to the build.
std::string version_text() {
  const std::string commit = VANTAGE_COMMIT;
  return commit.empty() ? VANTAGE_VERSION : vantage::concat(VANTAGE_VERSION, " (commit ", commit, ")");
}

/// Writes man pages and completions for the packages; not a command that people need, so no help mentions it.
void add_manual(CLI::App& program) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("write-manual", "Write man pages and shell completions into a folder");
  command->group("");
  command->add_option("folder", *folder, "where to write")->required();
  command->callback([folder, &program] {
    const std::filesystem::path to = *folder;
    std::filesystem::create_directories(to);
    vantage::write_file_atomically(to / "vantage.1", vantage::app::man_page(program, VANTAGE_VERSION));
    for (const CLI::App* each :
         program.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); })) {
      vantage::write_file_atomically(to / ("vantage-" + each->get_name() + ".1"),
                                     vantage::app::man_page(*each, VANTAGE_VERSION));
    }
    vantage::write_file_atomically(to / "vantage.bash", vantage::app::bash_completion(program));
    vantage::write_file_atomically(to / "_vantage", vantage::app::zsh_completion(program));
  });
}

int run(int argc, char** argv) {
  CLI::App program(
      "Vantage plans where a depth sensor should look next, so that an unknown object is scanned completely.");
  program.name("vantage");
  program.set_version_flag("--version", version_text());
  program.require_subcommand(1);
  program.failure_message(CLI::FailureMessage::help);
  vantage::app::add_reconstruct(program);
  vantage::app::add_plan(program);
  vantage::app::add_session(program);
  vantage::app::add_doctor(program);
  vantage::app::add_recording(program);
  vantage::app::add_evaluate(program);
  vantage::app::add_experiment(program);
  vantage::app::add_config(program);
  vantage::app::add_export(program);
  vantage::app::add_objects(program);
  vantage::app::add_view(program);
  vantage::app::add_serve(program);
  add_manual(program);
  vantage::app::arrange_help(program);
  if (argc < 2) {
    std::cout << program.help() << "\nTry this first: vantage reconstruct mug\n";
    return 0;
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& wanted) {  // --help and --version
    return program.exit(wanted);
  } catch (const CLI::RuntimeError& ended) {  // the command has said why
    return ended.get_exit_code();
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_command(program, argc, argv);
    std::cerr << "vantage: " << (unknown.empty() ? error.what() : unknown)
              << "\nRun `vantage --help` for what there is.\n";
    return misuse;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  give_back_large_blocks();
  vantage::app::prepare_standard_streams();
  try {
    const int code = run(argc, argv);
    vantage::app::finish_standard_output();
    return code;
  } catch (const vantage::InputError& error) {
    std::cerr << "vantage: " << vantage::printable(error.what()) << '\n';
    return misuse;
  } catch (const std::exception& error) {
    std::cerr << "vantage: " << vantage::printable(error.what()) << '\n';
    return failure;
  }
}
