#include "vantage/experiments/run_store.hpp"

#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/json_text.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t longest_stem = 60;

/// The object's name with the digest of the configuration: readable, and the same for every name that a run goes by.
std::string stem_of(const SweepRun& run) {
  const Json configuration = Json::parse(run.configuration);
  std::string stem;
  for (const char letter : configuration.value("object", configuration.value("kind", "run")))
    stem += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  return fmt::format("{}-{}", stem.substr(0, longest_stem), digest_of(run.configuration));
}

std::filesystem::path created(const std::filesystem::path& folder) {
  create_folders(folder);
  return folder;
}

/// What a killed sweep was writing when it was killed.
void remove_all_unfinished(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.') && name.ends_with(".tmp")) std::filesystem::remove(entry.path());
  }
}

std::string text_of(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace

// Results of earlier sweeps stay: the same folder may hold several experiments.
RunStore::RunStore(const std::filesystem::path& folder, std::string program, ForeignFiles foreign)
    : folder_(folder, {.command = "experiment", .files = {}, .patterns = {}}, foreign),
      runs_(created(folder / "runs")),
      times_(created(folder / "times")),
      program_(std::move(program)) {
  remove_all_unfinished(runs_);
  remove_all_unfinished(times_);
}

std::filesystem::path RunStore::file_of(const SweepRun& run) const { return runs_ / (stem_of(run) + ".json"); }
std::filesystem::path RunStore::times_of(const SweepRun& run) const { return times_ / (stem_of(run) + ".json"); }

std::optional<RunOutcome> RunStore::load(const SweepRun& run) const {
  const std::filesystem::path file = file_of(run), times = times_of(run);
  try {
    if (!std::filesystem::exists(file) || !std::filesystem::exists(times)) return std::nullopt;
    const nlohmann::json stored = parse_json(read_file(file), file.string());
    if (!stored.contains("outcome") || stored.value("program", "") != program_ ||
        stored.at("configuration") != nlohmann::json::parse(run.configuration))
      return std::nullopt;
    return outcome_from_json(stored["outcome"], parse_json(read_file(times), times.string()), file.string());
  } catch (const InputError&) {
    return std::nullopt;  // damaged by others: the run is repeated and the file replaced
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  } catch (const std::filesystem::filesystem_error&) {
    return std::nullopt;  // a loop of links, for example
  }
}

void RunStore::save(const SweepRun& run, const RunOutcome& outcome) const {
  // The times first: once the run's own file is there, the run is complete.
  write_file_atomically(times_of(run), text_of(times_json(outcome)));
  write_file_atomically(file_of(run), text_of({{"format", "vantage-experiment-run"},
                                               {"version", 1},
                                               {"program", program_},
                                               {"configuration", Json::parse(run.configuration)},
                                               {"outcome", outcome_json(outcome)}}));
}

void RunStore::save_failure(const SweepRun& run, const std::string& error) const {
  write_file_atomically(file_of(run), text_of({{"format", "vantage-experiment-run"},
                                               {"version", 1},
                                               {"program", program_},
                                               {"configuration", Json::parse(run.configuration)},
                                               {"error", error}}));
}

}  // namespace vantage
