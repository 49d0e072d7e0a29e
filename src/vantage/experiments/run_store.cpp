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
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(fmt::format("cannot create the folder {}: {}", folder.string(), error.message()));
  return folder;
}

/// What a killed sweep was writing when it was killed.
void remove_unfinished(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.') && name.ends_with(".tmp")) std::filesystem::remove(entry.path());
  }
}

std::string text_of(const Json& json) { return json.dump(1) + "\n"; }

}  // namespace

RunStore::RunStore(const std::filesystem::path& folder, std::string program)
    : runs_(created(folder / "runs")),
      times_(created(folder / "times")),
      lock_(folder, "another experiment is writing there; wait for it or choose another --out"),
      program_(std::move(program)) {
  remove_unfinished(runs_);
  remove_unfinished(times_);
}

std::filesystem::path RunStore::file_of(const SweepRun& run) const { return runs_ / (stem_of(run) + ".json"); }
std::filesystem::path RunStore::times_of(const SweepRun& run) const { return times_ / (stem_of(run) + ".json"); }

std::optional<RunOutcome> RunStore::load(const SweepRun& run) const {
  const std::filesystem::path file = file_of(run), times = times_of(run);
  if (!std::filesystem::exists(file) || !std::filesystem::exists(times)) return std::nullopt;
  try {
    const nlohmann::json stored = parse_json(read_file(file), file.string());
    if (!stored.contains("outcome") || stored.value("program", "") != program_ ||
        stored.at("configuration") != nlohmann::json::parse(run.configuration))
      return std::nullopt;
    return outcome_from_json(stored["outcome"], parse_json(read_file(times), times.string()), file.string());
  } catch (const InputError&) {
    return std::nullopt;  // damaged by others: the run is repeated and the file replaced
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
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
