#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "program_options.hpp"
#include "vantage/recordings/recording_info.hpp"

namespace vantage::app {
namespace {

struct RecordingRequest {
  std::string path;
  ProgramOptions program;
};

/// The word as a shell takes it for one.
std::string in_shell_quotes(const std::string& word) {
  const std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:=,+@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// The command that plans from this topic, in words that a shell takes.
std::string command_for(const std::string& path, const RecordingInfo::Source& source) {
  std::string command = "vantage plan " + in_shell_quotes(path);
  for (const std::string& word : source.options) command += " " + in_shell_quotes(word);
  return command;
}

nlohmann::ordered_json info_json(const std::string& path, const RecordingInfo& info) {
  nlohmann::ordered_json json{{"format", info.format}, {"duration_s", info.duration_s}};
  json["topics"] = nlohmann::ordered_json::array();
  for (const RecordingInfo::Topic& topic : info.topics) {
    json["topics"].push_back({{"name", topic.name},
                              {"type", topic.type},
                              {"encoding", topic.encoding},
                              {"messages", topic.messages},
                              {"rate_hz", topic.rate_hz},
                              {"content", topic.content},
                              {"frame", topic.frame_id}});
  }
  json["frames"] = info.frames;
  json["sources"] = nlohmann::ordered_json::array();
  for (const RecordingInfo::Source& source : info.sources) {
    nlohmann::ordered_json each{{"topic", source.topic}, {"reading", source.reading}};
    if (!source.options.empty()) each["command"] = command_for(path, source);
    json["sources"].push_back(std::move(each));
  }
  json["damage"] = info.damage;
  return json;
}

void print_info(const std::string& path, const RecordingInfo& info) {
  fmt::print("{}: {}, {:.1f} s\n", path, info.format, info.duration_s);
  std::size_t name_width = 5, type_width = 4;
  for (const RecordingInfo::Topic& topic : info.topics) {
    name_width = std::max(name_width, topic.name.size());
    type_width = std::max(type_width, topic.type.size());
  }
  fmt::print("\n{:<{}}  {:<{}}  {:>8}  {:>8}  content, frame\n", "topic", name_width, "type", type_width, "messages",
             "Hz");
  for (const RecordingInfo::Topic& topic : info.topics) {
    const bool is_read = topic.encoding == "cdr" || topic.encoding == "ros1";
    fmt::print("{:<{}}  {:<{}}  {:>8}  {:>8.1f}  {}{}{}{}\n", topic.name, name_width, topic.type, type_width,
               topic.messages, topic.rate_hz, topic.content,
               topic.content.empty() || topic.frame_id.empty() ? "" : ", ", topic.frame_id,
               is_read ? "" : "(" + topic.encoding + " is not read)");
  }
  if (!info.frames.empty()) fmt::print("\nframes of /tf\n");
  for (const std::string& line : info.frames) fmt::print("  {}\n", line);
  if (!info.damage.empty()) fmt::print("\nnot readable\n");
  for (const std::string& line : info.damage) fmt::print("  {}\n", line);
  fmt::print("\n{}\n", info.sources.empty() ? "no depth images and no clouds" : "to plan from it");
  for (const RecordingInfo::Source& source : info.sources) {
    fmt::print("  {}: {}\n", source.topic, source.reading);
    if (!source.options.empty()) fmt::print("    {}\n", command_for(path, source));
  }
}

void show_info(const RecordingRequest& request) {
  const RecordingInfo info = recording_info(request.path);
  if (request.program.json) {
    fmt::print("{}\n", info_json(request.path, info).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    print_info(request.path, info);
  }
}

}  // namespace

void add_recording(CLI::App& program) {
  CLI::App* recording = program.add_subcommand("recording", "Look into ROS bags: MCAP, sqlite3, ROS 1, RealSense");
  recording->require_subcommand(1);
  auto request = std::make_shared<RecordingRequest>();
  CLI::App* info = recording->add_subcommand("info", "List topics, rates and frames, and the command that reads them");
  info->add_option("recording", request->path, "a .mcap, .db3 or .bag file, also within .zstd, or a folder of them")
      ->required();
  add_program_options(*info, request->program);
  info->callback([request] { show_info(*request); });
}

}  // namespace vantage::app
