#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli_options.hpp"
#include "commands.hpp"
#include "program_options.hpp"
#include "vantage/core/error.hpp"
#include "vantage/experiments/experiments.hpp"
#include "vantage/io/atomic_file.hpp"

namespace vantage::app {
namespace {

struct Request {
  std::string name;
  std::string out = "runs/experiments";
  ExperimentOptions options;
  ProgramOptions program;
};

void write_part(const std::filesystem::path& folder, const ExperimentReport::Part& part) {
  std::visit([&folder](const auto& p) { write_file_atomically(folder / (p.name + ".csv"), csv(p)); }, part);
}

void experiment(const Request& request) {
  const auto threads = limit_threads(request.program.threads);
  const std::filesystem::path folder(request.out);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(fmt::format("cannot create the output folder {}: {}", folder.string(), error.message()));
  ExperimentReport report;
  report.title = request.name == "all" ? "The paper's experiments" : request.name;
  report.program = fmt::format("vantage {}", VANTAGE_VERSION);
  for (const std::string& name : request.name == "all" ? experiment_names() : std::vector<std::string>{request.name}) {
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [start] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const auto progress = [&](std::size_t done, std::size_t all) {
      if (!request.program.quiet)
        fmt::print(stderr, "\r{}: {}/{} runs of this step, {:.0f} s ", name, done, all, seconds());
    };
    for (ExperimentReport::Part& part : run_experiment(name, request.options, progress)) {
      write_part(folder, part);
      report.parts.push_back(std::move(part));
    }
    if (!request.program.quiet) fmt::print(stderr, "\r{}: done in {:.1f} s                    \n", name, seconds());
  }
  write_file_atomically(folder / "report.html", html(report));
  write_file_atomically(folder / "report.json", json(report).dump(2) + "\n");
  if (request.program.json) {
    fmt::print("{}\n", json(report).dump(2));
  } else {
    fmt::print("written to {}; open report.html there\n", folder.string());
  }
}

}  // namespace

void add_experiment(CLI::App& program) {
  auto request = std::make_shared<Request>();
  CLI::App* command = program.add_subcommand(
      "experiment", "Repeat the paper's tables and figures, with the paper's values beside ours");
  command->add_option("name", request->name, "table1, table2, table4, figure9, figure10, figure11 or all")->required();
  command->add_option("--out", request->out, "folder for CSV, JSON and report.html")->capture_default_str();
  add_options(*command, request->options);
  add_program_options(*command, request->program);
  command->callback([request] { experiment(*request); });
}

}  // namespace vantage::app
