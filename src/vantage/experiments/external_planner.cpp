#include "vantage/experiments/external_planner.hpp"

#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "vantage/core/error.hpp"
#include "vantage/files/temporary_folder.hpp"
#include "vantage/formats/map_file.hpp"

extern char** environ;  // NOLINT: POSIX

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

/// Another program with a line-wise conversation over a socket that is its standard input and output.
class Conversation {
 public:
  Conversation(const std::string& command, double timeout) : command_(command), timeout_(timeout) {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      throw Error(concat("external planner '", command, "': cannot make a socket: ", std::strerror(errno)));
    }
    ours_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    // A group of its own, so that all it starts can be ended; and a closed pipe ends it as it would end any program.
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setpgroup(&attributes, 0);
    std::string shell = "/bin/sh", dash_c = "-c", text = command;
    const std::array<char*, 4> arguments{shell.data(), dash_c.data(), text.data(), nullptr};
    const int failed = posix_spawn(&child_, shell.c_str(), &actions, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (failed != 0) {
      close(ours_);
      throw Error(concat("external planner '", command, "': cannot be started: ", std::strerror(failed)));
    }
  }
  Conversation(const Conversation&) = delete;
  Conversation& operator=(const Conversation&) = delete;
  ~Conversation() {
    close(ours_);
    // The closed socket asks it to end; after half a second it is made to.
    for (int i = 0; i < 50; ++i) {
      siginfo_t ended{};
      // Not reaped yet, so that its number stays that of the group.
      if (waitid(P_PID, static_cast<id_t>(child_), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid != 0)
        break;
      usleep(10'000);
    }
    kill(-child_, SIGKILL);  // also what it left running behind
    waitpid(child_, nullptr, 0);
  }

  [[nodiscard]] std::string ask(const std::string& line) {
    const auto end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_));
    const std::string bytes = line + "\n";
    for (std::size_t sent = 0; sent < bytes.size();) {
      wait_for(POLLOUT, end);
      const ssize_t count = send(ours_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (count > 0) {
        sent += static_cast<std::size_t>(count);
      } else if (errno != EAGAIN && errno != EINTR) {
        break;  // it does not read any more; it may have answered all the same
      }
    }
    while (true) {
      if (const auto newline = received_.find('\n'); newline != std::string::npos) {
        const std::string answer = received_.substr(0, newline);
        received_.erase(0, newline + 1);
        return answer;
      }
      wait_for(POLLIN, end);
      std::array<char, 4096> more{};
      const ssize_t count = recv(ours_, more.data(), more.size(), MSG_DONTWAIT);
      if (count > 0) {
        received_.append(more.data(), static_cast<std::size_t>(count));
        require_short();
      } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
        throw Error(concat("external planner '", command_, "': ended without an answer"));
      }
    }
  }
  [[nodiscard]] const std::string& command() const { return command_; }

 private:
  void wait_for(short events, Clock::time_point end) const {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd watched{ours_, events, 0};
    if (left > 0 && poll(&watched, 1, static_cast<int>(std::min<long long>(left, 1'000'000'000))) != 0) return;
    throw Error(concat("external planner '", command_, "': no answer within ", timeout_, " s"));
  }
  void require_short() const {
    constexpr std::size_t longest = 1 << 20;
    if (received_.size() <= longest) return;
    throw Error(concat("external planner '", command_, "': an answer of more than a megabyte without a line's end"));
  }

  std::string command_;
  double timeout_;
  int ours_ = -1;
  pid_t child_ = -1;
  std::string received_;
};

nlohmann::ordered_json matrix(const View& view) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int r = 0; r < 4; ++r) {
    nlohmann::ordered_json row = nlohmann::ordered_json::array();
    for (int c = 0; c < 4; ++c) row.push_back(view.world_from_sensor.matrix()(r, c));
    rows.push_back(row);
  }
  return rows;
}

nlohmann::ordered_json question(const Choice& choice, const std::filesystem::path& map) {
  nlohmann::ordered_json json;
  json["map"] = map.string();
  json["current"] = matrix(choice.current);
  json["scanned"] = nlohmann::ordered_json::array();
  for (const View& view : choice.scanned) json["scanned"].push_back(matrix(view));
  const RangeCamera& camera = choice.camera;
  json["camera"] = {{"columns", camera.resolution.columns},
                    {"rows", camera.resolution.rows},
                    {"tangents", {camera.left, camera.right, camera.top, camera.bottom}},
                    {"depth", {camera.min_depth, camera.max_depth}}};
  json["candidates"] = nlohmann::ordered_json::array();
  for (const ViewToJudge& view : choice.views) {
    json["candidates"].push_back({{"index", view.candidate},
                                  {"pose", matrix(view.view)},
                                  {"n_oc", view.seen.occupied},
                                  {"n_op", view.seen.occplane},
                                  {"n_um", view.seen.unmarked},
                                  {"travel", view.travel}});
  }
  return json;
}

/// The start of an answer, for a message: bytes that are no plain text would not go through JSON.
std::string start_of(const std::string& answer) {
  constexpr std::size_t longest = 200;
  std::string start;
  for (const char letter : answer.substr(0, longest)) start += letter >= ' ' && letter <= '~' ? letter : '?';
  return start;
}

int index_in(const std::string& answer, const std::string& command) {
  const nlohmann::json json = nlohmann::json::parse(answer, nullptr, false);
  if (json.is_object() && json.contains("index") && json["index"].is_number_integer()) {
    const nlohmann::json& index = json["index"];
    const bool fits = index.is_number_unsigned() ? std::in_range<int>(index.get<std::uint64_t>())
                                                 : std::in_range<int>(index.get<std::int64_t>());
    if (fits) return index.get<int>();
  }
  throw Error(concat("external planner '", command, "': answered '", start_of(answer),
                     "'; must be one line such as {\"index\": 3}"));
}

}  // namespace

void ExternalPlannerOptions::validate() const {
  require(!command.empty(), "external planner: the command is empty");
  require(timeout > 0 && std::isfinite(timeout), "external planner: timeout = ", timeout, " s: must be positive");
}

Utility external_planner(const ExternalPlannerOptions& options) {
  options.validate();
  const auto conversation = std::make_shared<Conversation>(options.command, options.timeout);
  const auto folder = std::make_shared<const TemporaryFolder>();
  const auto choose = [conversation, folder](const Choice& choice) {
    const std::filesystem::path map = folder->path() / "map.nrrd";
    write_map(choice.map, map);
    const int index = index_in(conversation->ask(question(choice, map).dump()), conversation->command());
    std::vector<double> scores(choice.views.size(), 0.0);
    bool is_known = false;
    for (std::size_t i = 0; i < scores.size(); ++i) {
      if (choice.views[i].candidate != index) continue;
      scores[i] = 1;
      is_known = true;
    }
    if (!is_known) {
      throw Error(concat("external planner '", conversation->command(), "': answered index ", index,
                         ", which is none of the candidates it was asked about"));
    }
    return scores;
  };
  return {.score = SetUtility(choose), .needs_all_views = true, .skips_scanned_views = true};
}

}  // namespace vantage
