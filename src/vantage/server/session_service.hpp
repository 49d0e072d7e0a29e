#pragma once

#include <condition_variable>
#include <deque>
#include <thread>

#include "vantage/server/http_server.hpp"
#include "vantage/server/scan_upload.hpp"
#include "vantage/server/session_page.hpp"
#include "vantage/session/session.hpp"

namespace vantage {

/// A session as HTTP gives it to robots (docs/openapi.yaml) and people. Two threads work behind the requests: one
/// merges what was stored, one plans what the page shows.
class SessionService {
 public:
  /// Opens the session; `run` shows it from then on and must outlive this.
  SessionService(const std::filesystem::path& folder, LiveRun& run);
  ~SessionService();
  SessionService(const SessionService&) = delete;
  SessionService& operator=(const SessionService&) = delete;

  /// Ends the work behind the requests, after the scan that is being merged; those that wait are merged when the
  /// session opens again, and requests that wait for them hear that they are stored.
  void stop();
  /// Adds everything below `/api/session`. This must outlive the server.
  void add_routes(HttpServer& server);
  [[nodiscard]] Session& session() { return *session_; }

 private:
  using Handler = HttpAnswer (SessionService::*)(const HttpRequest&);

  [[nodiscard]] HttpAnswer status(const HttpRequest& request);
  [[nodiscard]] HttpAnswer add_scan(const HttpRequest& request);
  [[nodiscard]] HttpAnswer next(const HttpRequest& request);
  [[nodiscard]] HttpAnswer take(const HttpRequest& request);
  [[nodiscard]] HttpAnswer skip(const HttpRequest& request);
  [[nodiscard]] HttpAnswer unskip(const HttpRequest& request);
  [[nodiscard]] HttpAnswer remove(const HttpRequest& request);
  [[nodiscard]] HttpAnswer restore(const HttpRequest& request);
  [[nodiscard]] HttpAnswer finish(const HttpRequest& request);
  [[nodiscard]] HttpAnswer map_labels(const HttpRequest& request);
  [[nodiscard]] HttpAnswer map_surface(const HttpRequest& request);
  [[nodiscard]] HttpAnswer model(const HttpRequest& request);
  [[nodiscard]] HttpAnswer mesh(const HttpRequest& request);

  [[nodiscard]] std::function<HttpAnswer(const HttpRequest&)> handler(Handler handle);
  [[nodiscard]] std::string without_paths(std::string text) const;
  [[nodiscard]] nlohmann::ordered_json status_now();
  /// A scan that was sent.
  struct StoredUpload {
    int number = 0;
    std::optional<int> same_as;  // another one with the same measurements and pose
    /// As JSON, beside what `json` has.
    [[nodiscard]] nlohmann::ordered_json with_json(nlohmann::ordered_json json) const;
  };
  [[nodiscard]] StoredUpload store_upload(const HttpRequest& request, const SessionState& state);
  [[nodiscard]] StoredUpload store(SessionScan scan);
  void was_merged(const SessionModel& model);
  void want_plan();
  void integrate_stored();
  void plan_for_page();

  SessionPage page_;
  std::unique_ptr<Session> session_;
  UploadOptions upload_;

  std::mutex unpacking_;

  std::mutex mesh_mutex_;
  std::shared_ptr<const SessionState> meshed_;  // what mesh_ is of
  std::shared_ptr<const std::string> mesh_;

  std::mutex mutex_;  // guards the rest
  std::condition_variable stored_, merged_, plan_wanted_;
  std::deque<int> to_merge_;
  int merged_up_to_ = -1;
  bool wants_plan_ = false;
  std::optional<Evaluation> taken_;  // the view that somebody goes to
  std::string page_fault_;           // why the page lacks something, if it does
  bool ends_ = false;
  std::thread integrator_, planner_;
};

}  // namespace vantage
