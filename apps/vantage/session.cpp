#include "vantage/session/session.hpp"
#include "vantage/report/static_report.hpp"

#include <fmt/core.h>

#include <memory>

#include "cli_options.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "notes.hpp"
#include "plan_table.hpp"
#include "program_options.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/plain_text.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/runs/ranked_views.hpp"
#include "vantage/session/session_json.hpp"

namespace vantage::app {
namespace {

struct SessionRequest {
  std::string folder;
  std::set<std::string> given;     // new: names of options that the user set
  ScanPlanningOptions options;     // new
  std::vector<std::string> scans;  // add
  std::optional<int> candidate;    // add
  bool again = false;              // add
  std::vector<std::pair<std::string, std::string>>
      changed;                      // add: options of reading that are other than the session's
  int top = 10;                     // next
  std::optional<int> skip, unskip;  // next
  std::string reason;               // next
  std::vector<int> numbers;         // remove, restore
  bool overwrite = false;           // finish
  bool conclude = false;            // finish
  ProgramOptions program;
};

using Shared = std::shared_ptr<SessionRequest>;

void tell_dropped(const SessionStatus& status) {
  for (const std::string& each : status.dropped) print_note("vantage: {}\n", printable(each));
  for (const auto& [number, reason] : status.left_out)
    print_note("vantage: left out scan {}, which is safe on disk: {}\n", number, printable(reason));
}

void create(SessionRequest& request) {
  print_hints(load_robot(request.options.planning, request.given));
  Session::create(request.folder, request.options);
  if (!request.program.quiet) fmt::print("new session in {}\n", request.folder);
}

ScanFolderOptions reading_options(const SessionRequest& request, const Session& session) {
  ScanFolderOptions reading = session.options().reading;
  const std::vector<OptionField> fields = option_fields(reading);
  for (const auto& [name, text] : request.changed) set_option(fields_named(fields, {name}).front(), text, "--" + name);
  return reading;
}

void add(SessionRequest& request) {
  const auto threads = limit_threads(request.program.threads);
  Session session(request.folder);
  tell_dropped(session.status());
  const ScanFolderOptions reading = reading_options(request, session);
  std::vector<ScanFile> files;
  for (const std::string& path : request.scans) {
    reading.require_poses();
    ScanSet set = open_scans(path, reading);
    if (!request.program.quiet) print_scan_set(set);
    for (ScanFile& file : set.scans) files.push_back(std::move(file));
  }
  require(!request.candidate || files.size() == 1, "candidate = ", request.candidate.value_or(0),
          ": is for one scan, there are ", files.size());
  catch_interrupts();
  nlohmann::ordered_json added = nlohmann::ordered_json::array(), already = nlohmann::ordered_json::array();
  std::size_t stored = 0;
  for (const ScanFile& file : files) {
    if (was_interrupted()) break;
    ++stored;
    SessionScan scan{file.name, file.view, file.read(), request.candidate};
    const std::optional<int> same = request.again ? std::nullopt : session.same_scan(scan);
    if (same) {
      // A folder may be given again once it holds more.
      already.push_back({{"name", file.name}, {"number", *same}});
      print_note("vantage: left out {}, which is there already as scan {}; --again adds it all the same\n",
                 printable(file.name), *same);
      continue;
    }
    const int number = session.store(std::move(scan));
    const ScanRecord record = session.integrate(number);
    if (request.program.json) {
      added.push_back(session_scan_json(number, record));
    } else {
      fmt::print("stored scan {:>3}  ", number);
      fmt::print("{}", record_line(record));
      std::fflush(stdout);
    }
  }
  if (request.program.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"scans", added}, {"already_there", already}}.dump(2));
  for (const std::string& warning : session.status().warnings) print_note("vantage: {}\n", printable(warning));
  if (stored < files.size()) throw Error(fmt::format("interrupted: {} of {} scans are stored", stored, files.size()));
}

void next(SessionRequest& request) {
  const auto threads = limit_threads(request.program.threads);
  require(request.top >= 0, "top = ", request.top, ": must not be negative");
  require(request.reason.empty() || request.skip, "reason: belongs to --skip");
  Session session(request.folder);
  tell_dropped(session.status());
  if (request.skip) session.skip(*request.skip, request.reason);
  if (request.unskip) session.unskip(*request.unskip);
  const SessionPlan plan = session.next();
  if (request.program.json) {
    fmt::print("{}\n", ranked_views_json(plan.plan, plan.why_finished, plan.state->scans, request.top).dump(2));
  } else {
    print_plan(plan.plan, plan.why_finished, {request.top, request.program.verbose});
  }
}

void tell_how_it_stands(Session& session, const ProgramOptions& program) {
  const SessionStatus status = session.status();
  if (program.json) {
    fmt::print("{}\n", status_json(status).dump(2));
    return;
  }
  if (program.quiet) return;
  fmt::print("{}: {} scans, {} of them merged, {:.2f} m travelled\n ", session.folder().string(), status.stored,
             status.merged, status.state->scans.empty() ? 0 : status.state->scans.back().distance);
  for (const Label label : all_labels) fmt::print(" {} {} ", status.state->map.count(label), name(label));
  fmt::print(" mean quality {:.3f}\n", status.state->map.mean_quality());
  for (const int number : status.removed) fmt::print("scan {} was taken out\n", number);
  for (const auto& [candidate, reason] : status.skipped)
    fmt::print("view {} is skipped: {}\n", candidate, printable(reason));
}

void status(SessionRequest& request) {
  Session session(request.folder);
  tell_dropped(session.status());
  ProgramOptions program = request.program;
  program.quiet = false;  // it was asked for
  tell_how_it_stands(session, program);
}

void remove(SessionRequest& request) {
  const auto threads = limit_threads(request.program.threads);
  Session session(request.folder);
  tell_dropped(session.status());
  for (const int number : request.numbers) {
    session.remove(number);
    if (!request.program.quiet && !request.program.json)
      fmt::print("took out scan {}; `vantage session restore` puts it back\n", number);
  }
  tell_how_it_stands(session, request.program);
}

void restore(SessionRequest& request) {
  const auto threads = limit_threads(request.program.threads);
  Session session(request.folder);
  tell_dropped(session.status());
  for (const int number : request.numbers) session.restore(number);
  tell_how_it_stands(session, request.program);
}

void finish(SessionRequest& request) {
  const auto threads = limit_threads(request.program.threads);
  Session session(request.folder);
  tell_dropped(session.status());
  session.finish(report_page, request.overwrite ? ForeignFiles::overwrite : ForeignFiles::refuse,
                 request.conclude ? Session::Ending::concluded : Session::Ending::as_it_stands);
  if (!request.program.quiet) fmt::print("written to {}; open report.html there\n", request.folder);
}

/// The fields, so that a value is checked and also kept in `changed`.
std::vector<OptionField> noting_fields(const Shared& request) {
  std::vector<OptionField> fields = option_fields(request->options.reading);
  for (OptionField& field : fields) {
    field.set = [set = field.set, name = field.name, request](std::string_view text) {
      request->changed.emplace_back(name, text);
      return set(text);
    };
  }
  return fields;
}

/// Adds `session NAME DIR`.
CLI::App* add_step(CLI::App& session, const char* name, const char* help, const Shared& request,
                   void (*run)(SessionRequest&)) {
  CLI::App* step = session.add_subcommand(name, help);
  step->add_option("dir", request->folder, "folder of the session")->required();
  step->callback([request, run] { run(*request); });
  return step;
}

}  // namespace

void add_session(CLI::App& program) {
  CLI::App* session = program.add_subcommand(
      "session", "Scan over hours: a folder that scans are added to and views are asked of, across restarts");
  session->require_subcommand(1);

  const auto for_new = std::make_shared<SessionRequest>();
  CLI::App* step = add_step(*session, "new", "Start a session; the options are those of plan", for_new, create);
  add_options(*step, noting(option_fields(for_new->options), for_new->given));
  add_program_options(*step, for_new->program);

  const auto for_add = std::make_shared<SessionRequest>();
  step =
      add_step(*session, "add", "Add scans with their poses; each is safe on disk once it is reported", for_add, add);
  step->add_option("scans", for_add->scans, "depth frames, clouds, folders of them, ROS bags, or Stanford .conf files")
      ->required();
  step->add_option("--candidate", for_add->candidate, "the planned view that this one scan was taken from");
  step->add_flag("--again", for_add->again, "add scans too that are there already with the same measurements and pose");
  add_options(*step, noting_fields(for_add));
  add_program_options(*step, for_add->program);

  const auto for_next = std::make_shared<SessionRequest>();
  step = add_step(*session, "next", "Say where to look next, with the reasons", for_next, next);
  step->add_option("--top", for_next->top, "views to print, best first")->capture_default_str();
  step->add_option("--skip", for_next->skip, "do not plan this view again");
  step->add_option("--reason", for_next->reason, "why it is skipped");
  step->add_option("--unskip", for_next->unskip, "plan this view again");
  add_program_options(*step, for_next->program);

  const auto for_status = std::make_shared<SessionRequest>();
  step = add_step(*session, "status", "Say how the session stands", for_status, status);
  add_program_options(*step, for_status->program);

  const auto for_remove = std::make_shared<SessionRequest>();
  step = add_step(*session, "remove", "Take scans out, as if they had never come; their files are kept", for_remove,
                  remove);
  step->add_option("numbers", for_remove->numbers, "numbers of the scans, as add and status say them")->required();
  add_program_options(*step, for_remove->program);

  const auto for_restore = std::make_shared<SessionRequest>();
  step = add_step(*session, "restore", "Put scans back that were taken out", for_restore, restore);
  step->add_option("numbers", for_restore->numbers, "numbers of the scans, as remove said them")->required();
  add_program_options(*step, for_restore->program);

  const auto for_finish = std::make_shared<SessionRequest>();
  step = add_step(*session, "finish", "Write model, mesh, map, views.csv, summary.json and report.html", for_finish,
                  finish);
  step->add_flag("--overwrite", for_finish->overwrite, "replace files of these names that the session did not write");
  step->add_flag("--conclude", for_finish->conclude,
                 "no scan follows: try refused scans again and improve all poses together before writing");
  add_program_options(*step, for_finish->program);
}

}  // namespace vantage::app
