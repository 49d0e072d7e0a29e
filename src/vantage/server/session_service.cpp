#include "vantage/server/session_service.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/report/report.hpp"
#include "vantage/report/static_report.hpp"
#include "vantage/runs/ranked_views.hpp"
#include "vantage/server/session_request.hpp"
#include "vantage/server/without_folders.hpp"
#include "vantage/session/session_json.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t longest_scan = std::size_t{64} << 20U;  // bytes
constexpr int most_uploads = 16;                              // at a time
constexpr int most_plans = 16;                                // requests for one, at a time
constexpr int most_downloads = 4;                             // of a file, at a time
constexpr std::int64_t most_times_larger = 4;                 // a frame may be than those of the session
constexpr std::size_t most_waiting = 32;                      // scans that are stored and not merged
constexpr int default_top = 10;

HttpAnswer json_answer(const Json& json, int status = 200) {
  return {.status = status,
          .body = std::make_shared<const std::string>(json.dump(-1, ' ', false, Json::error_handler_t::replace))};
}

/// Whether a robot that errs by no more than the options say may have been sent to `view`.
bool is_near(const View& believed, const View& view, const ScanPlanOptions& options) {
  const double distance = (believed.position() - view.position()).norm();
  const double angle = rotation_angle(believed.world_from_sensor.linear(), view.world_from_sensor.linear());
  return distance <= options.pose_error && angle <= radians(options.pose_angle_error);
}

/// The view of this candidate in the plan. Throws HttpError 409 saying why where it is not to be had now.
const Evaluation& view_of(const Plan& plan, int candidate) {
  const auto is_it = [&](const Evaluation& each) { return each.candidate == candidate; };
  const auto ranked = std::find_if(plan.ranking.begin(), plan.ranking.end(), is_it);
  if (ranked != plan.ranking.end()) return *ranked;
  const auto fallen = std::find_if(plan.infeasible.begin(), plan.infeasible.end(), is_it);
  throw HttpError(409, concat("candidate = ", candidate, ": cannot be taken now, ",
                              fallen != plan.infeasible.end() ? fallen->reason : "it was not evaluated"));
}

}  // namespace

SessionService::SessionService(const std::filesystem::path& folder, LiveRun& run)
    : page_(SessionFolder::options_of(folder), name_of_folder(folder), run) {
  session_ = std::make_unique<Session>(folder, [this](const SessionModel& model) { was_merged(model); });
  upload_ = upload_options(session_->options().reading);
  try {
    integrator_ = std::thread([this] { integrate_stored(); });
    planner_ = std::thread([this] { plan_for_page(); });
  } catch (const std::system_error& error) {
    stop();
    throw Error(concat("cannot start the threads of the session (", error.what(),
                       "): the limit of processes (ulimit -u, or the container's) is reached"));
  }
}

SessionService::~SessionService() { stop(); }

void SessionService::stop() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  for (std::condition_variable* each : {&stored_, &merged_, &plan_wanted_}) each->notify_all();
  for (std::thread* each : {&integrator_, &planner_})
    if (each->joinable()) each->join();
}

void SessionService::was_merged(const SessionModel& model) {
  try {
    page_.add_scan(model);
  } catch (const std::exception& error) {
    // What the page does changes nothing of the model.
    const std::lock_guard lock(mutex_);
    page_fault_ = concat("the page does not show all scans: ", error.what());
  }
  const std::lock_guard lock(mutex_);
  if (taken_ && model.model().scans.back().candidate == taken_->candidate) taken_.reset();
  wants_plan_ = true;
  plan_wanted_.notify_all();
}

void SessionService::want_plan() {
  const std::lock_guard lock(mutex_);
  wants_plan_ = true;
  plan_wanted_.notify_all();
}

void SessionService::integrate_stored() {
  std::unique_lock lock(mutex_);
  while (true) {
    stored_.wait(lock, [&] { return ends_ || !to_merge_.empty(); });
    if (ends_) return;
    const int number = to_merge_.front();
    to_merge_.pop_front();
    lock.unlock();
    try {
      (void)session_->integrate(number);
    } catch (const std::exception&) {
      // The state of the session says it, and whoever waits for the scan gets an error.
    }
    lock.lock();
    merged_up_to_ = std::max(merged_up_to_, number);
    merged_.notify_all();
  }
}

void SessionService::plan_for_page() {
  std::unique_lock lock(mutex_);
  while (true) {
    plan_wanted_.wait(lock, [&] { return ends_ || wants_plan_; });
    if (ends_) return;
    wants_plan_ = false;
    lock.unlock();
    try {
      page_.add_plan(session_->next());
    } catch (const std::exception&) {
      // Whoever asks for the next view gets the error.
    }
    lock.lock();
  }
}

std::string SessionService::without_paths(std::string text) const {
  return without_folders(std::move(text), session_->folder());
}

std::function<HttpAnswer(const HttpRequest&)> SessionService::handler(Handler handle) {
  return [this, handle](const HttpRequest& request) {
    try {
      return (this->*handle)(request);
    } catch (const HttpError&) {
      throw;
    } catch (const InputError& error) {
      throw HttpError(400, without_paths(error.what()));
    } catch (const std::exception& error) {
      throw HttpError(500, without_paths(error.what()));
    }
  };
}

Json SessionService::status_now() {
  SessionStatus status = session_->status();
  {
    const std::lock_guard lock(mutex_);
    if (!page_fault_.empty()) status.warnings.push_back(page_fault_);
  }
  for (std::string& text : status.dropped) text = without_paths(text);
  for (std::string& text : status.warnings) text = without_paths(text);
  for (auto& [number, text] : status.left_out) text = without_paths(text);
  Json json = status_json(status);
  const std::lock_guard lock(mutex_);
  json["taken"] = taken_ ? Json{{"candidate", taken_->candidate}, {"pose", pose_json(taken_->view)}} : Json(nullptr);
  return json;
}

HttpAnswer SessionService::status(const HttpRequest& request) {
  require_query(request, {});
  return json_answer(status_now());
}

Json SessionService::StoredUpload::with_json(Json json) const {
  if (same_as) json["same_as"] = *same_as;
  return json;
}

SessionService::StoredUpload SessionService::store(SessionScan scan) {
  const int views = session_->options().scene.views;
  require(scan.candidate.value_or(0) < views, "candidate = ", scan.candidate.value_or(0),
          ": must be one of the views 0 .. ", views - 1);
  {
    const std::lock_guard lock(mutex_);
    // Where the scan does not say, its pose does: others may send scans while somebody is on the way.
    const bool is_of_taken =
        taken_ && (scan.candidate ? *scan.candidate == taken_->candidate
                                  : is_near(scan.believed, taken_->view, session_->options().scene));
    if (is_of_taken) {
      scan.candidate = taken_->candidate;
      if (!scan.commanded) scan.commanded = taken_->view;
    }
  }
  try {
    const std::optional<int> same = session_->same_scan(scan);
    const int number = session_->store(std::move(scan));
    return {number, same == number ? std::nullopt : same};
  } catch (const InputError&) {
    throw;
  } catch (const Error& error) {
    throw HttpError(507, concat("the scan is not stored: ", without_paths(error.what())));
  }
}

SessionService::StoredUpload SessionService::store_upload(const HttpRequest& request, const SessionState& state) {
  UploadOptions upload = upload_;
  const auto& camera = state.camera;
  if (camera)
    upload.most_pixels = std::min(upload.most_pixels, most_times_larger * std::int64_t{camera->resolution.rays()});
  // One at a time, so that what is unpacked at a time is limited too.
  const std::lock_guard lock(unpacking_);
  return store(parse_scan_upload(request.body, request.boundary, upload));
}

HttpAnswer SessionService::add_scan(const HttpRequest& request) {
  require_query(request, {"wait"});
  const bool waits = query_is_yes(request, "wait");
  const SessionStatus status = session_->status();
  if (status.stored >= status.integrated + status.left_out.size() + most_waiting)
    throw HttpError(503, concat(most_waiting, " scans wait to be merged; try again later"));
  const StoredUpload stored = store_upload(request, *status.state);
  const int number = stored.number;
  {
    std::unique_lock lock(mutex_);
    if (number > merged_up_to_) to_merge_.push_back(number);  // else it was sent again
    stored_.notify_all();
    if (waits) merged_.wait(lock, [&] { return ends_ || merged_up_to_ >= number; });
    if (!waits || merged_up_to_ < number) return json_answer(stored.with_json({{"number", number}}), 202);
  }
  return json_answer(stored.with_json(session_scan_json(number, session_->integrate(number))), 201);
}

HttpAnswer SessionService::next(const HttpRequest& request) {
  require_query(request, {"top"});
  const int top = query_number(request, "top", default_top);
  const SessionPlan plan = session_->next();
  return json_answer(ranked_views_json(plan.plan, plan.why_finished, plan.state->scans, top));
}

HttpAnswer SessionService::take(const HttpRequest& request) {
  const auto body = body_object(request, {"candidate"});
  const SessionPlan plan = session_->next();
  if (!plan.plan) throw HttpError(409, plan.why_finished);
  const int views = session_->options().scene.views;
  const Evaluation& view =
      body.contains("candidate") ? view_of(*plan.plan, body_candidate(body, views)) : plan.plan->best;
  page_.add_take(view);
  {
    const std::lock_guard lock(mutex_);
    taken_ = view;
  }
  Json json = view_json(view);
  json["pose"] = pose_json(view.view);
  return json_answer(json);
}

HttpAnswer SessionService::skip(const HttpRequest& request) {
  const auto body = body_object(request, {"candidate", "reason"});
  const int candidate = body_candidate(body, session_->options().scene.views);
  session_->skip(candidate, body_text(body, "reason"));
  {
    const std::lock_guard lock(mutex_);
    if (taken_ && taken_->candidate == candidate) taken_.reset();
  }
  want_plan();
  return json_answer(status_now());
}

HttpAnswer SessionService::unskip(const HttpRequest& request) {
  session_->unskip(body_candidate(body_object(request, {"candidate"}), session_->options().scene.views));
  want_plan();
  return json_answer(status_now());
}

HttpAnswer SessionService::remove(const HttpRequest& request) {
  session_->remove(body_scan(body_object(request, {"number"})));
  if (session_->status().integrated == 0) page_.clear();
  want_plan();
  return json_answer(status_now());
}

HttpAnswer SessionService::restore(const HttpRequest& request) {
  session_->restore(body_scan(body_object(request, {"number"})));
  want_plan();
  return json_answer(status_now());
}

HttpAnswer SessionService::finish(const HttpRequest& request) {
  (void)body_object(request, {});
  if (session_->status().integrated == 0) throw HttpError(409, "there is no scan yet; add one");
  try {
    session_->finish(report_page);
    const std::string report = (session_->folder() / "report.html").string();
    if (const auto document = document_of_page(read_file(report), report)) page_.add_result(*document);
    return json_answer(Json::parse(read_file(session_->folder() / "summary.json")));
  } catch (const InputError& error) {
    throw HttpError(500, without_paths(error.what()));  // not an error of the request
  }
}

void SessionService::add_routes(HttpServer& server) {
  using Method = HttpRoute::Method;
  const auto on = [&](Method method, const std::string& path, Handler handle, int at_once = 0) {
    server.add({.method = method, .path = path, .handle = handler(handle), .at_once = at_once});
  };
  server.add({.method = Method::post,
              .path = "/api/session/scans",
              .handle = handler(&SessionService::add_scan),
              .body_type = "multipart/form-data",
              .max_body = longest_scan,
              .at_once = most_uploads});
  on(Method::get, "/api/session", &SessionService::status);
  on(Method::get, "/api/session/next", &SessionService::next, most_plans);
  on(Method::post, "/api/session/next", &SessionService::take, most_plans);
  on(Method::post, "/api/session/skip", &SessionService::skip);
  on(Method::post, "/api/session/unskip", &SessionService::unskip);
  on(Method::post, "/api/session/remove", &SessionService::remove, 1);
  on(Method::post, "/api/session/restore", &SessionService::restore, 1);
  on(Method::post, "/api/session/finish", &SessionService::finish, 1);
  on(Method::get, "/api/session/map.nrrd", &SessionService::map_labels, most_downloads);
  on(Method::get, "/api/session/map.ply", &SessionService::map_surface, most_downloads);
  on(Method::get, "/api/session/model.ply", &SessionService::model, most_downloads);
  on(Method::get, "/api/session/mesh.ply", &SessionService::mesh, most_downloads);
}

}  // namespace vantage
