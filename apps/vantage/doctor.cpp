#include "vantage/doctor/doctor.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cli_options.hpp"
#include "commands.hpp"
#include "notes.hpp"
#include "program_options.hpp"
#include "vantage/core/error.hpp"

namespace vantage::app {
namespace {

struct DoctorRequest {
  std::string scans;
  DoctorOptions options;
  ProgramOptions program;
};

nlohmann::ordered_json diagnosis_json(const Diagnosis& diagnosis) {
  nlohmann::ordered_json json{{"healthy", diagnosis.healthy()},
                              {"frames", diagnosis.frames},
                              {"every", diagnosis.every},
                              {"all_frames", diagnosis.all_frames},
                              {"agreement", diagnosis.agreement},
                              {"best_agreement", diagnosis.best_agreement},
                              {"contradiction", diagnosis.contradiction},
                              {"compared", !diagnosis.not_compared},
                              {"recognised", diagnosis.recognised},
                              {"left_out", diagnosis.left_out},
                              {"checks", diagnosis.checks},
                              {"findings", nlohmann::ordered_json::array()}};
  for (const Finding& finding : diagnosis.findings) {
    json["findings"].push_back({{"check", finding.check},
                                {"wrong", finding.wrong},
                                {"fix", finding.fix},
                                {"evidence", finding.evidence},
                                {"note", finding.is_note}});
  }
  return json;
}

/// Checks that one frame alone allows.
bool needs_no_comparison(std::string_view check) {
  return check == "frames" || check == "rotation" || check == "no-return" || check == "intrinsics";
}

enum class Shown { every_check, findings };

void print_diagnosis(const Diagnosis& diagnosis, Shown shown) {
  for (const CheckName& check : doctor_checks()) {
    bool content = true;
    for (const Finding& finding : diagnosis.findings) {
      if (finding.check != check.name) continue;
      content = false;
      fmt::print("{}  {:<14}  {}\n       {:<14}  fix: {}\n       {:<14}  because {}\n",
                 finding.is_note ? "note " : "WRONG", check.name, finding.wrong, "", finding.fix, "", finding.evidence);
    }
    if (!content || shown == Shown::findings) continue;
    if (diagnosis.not_compared && !needs_no_comparison(check.name)) {
      fmt::print("-      {:<14}  not checked: it takes two frames or more\n", check.name);
    } else {
      fmt::print("ok     {:<14}  looked for {}\n", check.name, check.looks_for);
    }
  }
  if (diagnosis.every > 1) fmt::print("looked at every {}th of {} frames\n", diagnosis.every, diagnosis.all_frames);
  if (diagnosis.not_compared) {
    fmt::print("{} frames; nothing can be compared\n", diagnosis.frames);
  } else {
    fmt::print(
        "{} frames; as given they agree in {:.1f} % of their points and contradict each other in {:.1f} % of what "
        "they both look at\n",
        diagnosis.frames, 100 * diagnosis.agreement, 100 * diagnosis.contradiction);
  }
  if (!diagnosis.healthy()) {
    const auto wrong = std::count_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                                     [](const Finding& finding) { return !finding.is_note; });
    fmt::print("{} to fix\n", wrong);
  }
}

void doctor(const DoctorRequest& request) {
  const auto threads = limit_threads(request.program.threads);
  const bool shows_progress = !request.program.quiet && isatty(STDERR_FILENO) != 0;
  const Diagnosis diagnosis = examine(request.scans, request.options, [&](const std::string& what) {
    if (shows_progress) print_note("\r\033[K{}", what);
  });
  if (shows_progress) print_note("\r\033[K");
  if (!request.program.quiet) {
    if (!diagnosis.recognised.empty()) print_note("{}\n", diagnosis.recognised);
    for (const std::string& each : diagnosis.left_out) print_note("left out: {}\n", each);
  }
  if (request.program.json) {
    fmt::print("{}\n", diagnosis_json(diagnosis).dump(2));
  } else {
    print_diagnosis(diagnosis, request.program.quiet ? Shown::findings : Shown::every_check);
  }
  if (!diagnosis.healthy()) throw CLI::RuntimeError(1);
}

}  // namespace

void add_doctor(CLI::App& program) {
  auto request = std::make_shared<DoctorRequest>();
  CLI::App* command = program.add_subcommand("doctor", "Find what is wrong with real scans, and say how to fix it");
  command->add_option("scans", request->scans, "folder of depth frames or clouds with poses, or a Stanford .conf")
      ->required();
  add_options(*command, request->options);
  add_program_options(*command, request->program);
  command->footer(
      "With --quiet only what was found is printed, not what is all right.\n"
      "Exit code: 0 where all is well, 1 where something is wrong, 2 for misuse.");
  command->callback([request] { doctor(*request); });
}

}  // namespace vantage::app
