#include "vantage/experiments/sweep_messages.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "vantage/files/json_text.hpp"

namespace vantage {
namespace {

constexpr std::array<const char*, 5> kinds{"want", "run", "stop", "result", "bye"};

}  // namespace

std::string encode(const SweepMessage& message) {
  nlohmann::ordered_json json{{"kind", kinds.at(static_cast<std::size_t>(message.kind))},
                              {"run", message.run},
                              {"text", message.text},
                              {"error", message.result.error},
                              {"interrupted", message.result.interrupted}};
  if (message.result.outcome) {
    json["outcome"] = outcome_json(*message.result.outcome);
    json["times"] = times_json(*message.result.outcome);
  }
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

SweepMessage decode(const std::string& bytes) {
  const std::string name = "a message of another rank";
  try {
    const nlohmann::json json = parse_json(bytes, name);
    SweepMessage message;
    std::size_t kind = 0;
    while (kinds.at(kind) != json.at("kind").get<std::string>()) ++kind;
    message.kind = static_cast<SweepMessage::Kind>(kind);
    message.run = json.at("run").get<std::size_t>();
    message.text = json.at("text").get<std::string>();
    message.result.error = json.at("error").get<std::string>();
    message.result.interrupted = json.at("interrupted").get<bool>();
    if (json.contains("outcome"))
      message.result.outcome = outcome_from_json(json.at("outcome"), json.at("times"), name);
    return message;
  } catch (const std::exception& error) {
    throw Error(concat(name, " is not understood: ", error.what()));
  }
}

std::string digest_of(std::span<const SweepRun> runs) {
  std::string all;
  for (const SweepRun& run : runs) all += run.configuration + "\n";
  return digest_of(std::string_view(all));
}

}  // namespace vantage
