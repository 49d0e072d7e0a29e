#include "vantage/server/session_page.hpp"

#include "vantage/core/error.hpp"
#include "vantage/runs/run_document.hpp"
#include "vantage/runs/run_files.hpp"

namespace vantage {

SessionPage::SessionPage(const ScanPlanningOptions& options, const std::string& name, LiveRun& run)
    : run_(run), options_(options) {
  for (const OptionField& field : option_fields(options_)) data_.options.emplace_back(field.name, field.text());
  data_.command = "session";
  data_.object = name;
  data_.program = VANTAGE_VERSION;
  data_.state = RunData::State::waiting;
  const SceneOptions scene = scene_in(session_box(options_), options_.scene).scene;
  data_.grid = scene.grid();
  data_.enclosure = scene.enclosure();
  begin();
}

void SessionPage::begin() {
  set_up(options_.scene.radius.value_or(0), std::nullopt);
  scans_ = 0;
  plan_.reset();
  is_finished_ = false;
  run_.begin(run_json(data_));
}

void SessionPage::clear() {
  const std::lock_guard lock(mutex_);
  begin();
}

void SessionPage::set_up(double radius, const std::optional<RangeCamera>& camera) {
  radius_ = radius;
  has_camera_ = camera.has_value();
  data_.camera = options_.camera(camera);
  if (radius > 0) {
    data_.candidates = view_sphere(options_.scene.views, radius, session_box(options_).center());
    data_.candidates_text = concat("sphere:", options_.scene.views, ":", radius);
  }
}

void SessionPage::add_scan(const SessionModel& model) {
  const std::lock_guard lock(mutex_);
  if (model.model().scans.size() <= scans_) begin();  // scans were taken out or put back
  if (is_finished_) run_.add("state", {{"state", "waiting"}, {"stop_reason", ""}, {"summary", nullptr}});
  is_finished_ = false;
  if (model.radius() != radius_ || model.camera().has_value() != has_camera_) {
    set_up(model.radius(), model.camera());
    run_.add("setup", setup_json(data_));
  }
  data_.add_scan(model.model().scans.back(), model.model(), nullptr);
  data_.scans.back().plan = std::exchange(plan_, std::nullopt);
  run_.add("scan", scan_json(data_.scans.back()));
  data_.scans.clear();
  scans_ = model.model().scans.size();
}

void SessionPage::add_plan(const SessionPlan& plan) {
  const std::lock_guard lock(mutex_);
  if (plan.state->scans.size() != scans_ || scans_ == 0) return;
  const std::size_t views = data_.candidates.views.size();
  plan_ = plan.plan ? candidate_plan(*plan.plan, views)
                    : CandidatePlan{.chosen = std::nullopt, .evaluations = std::vector<Evaluation>(views)};
  run_.add("plan", plan_json(*plan_));
  run_.add("state", {{"stop_reason", plan.why_finished}});
}

void SessionPage::add_take(const Evaluation& view) {
  run_.add("take", {{"candidate", view.candidate}, {"pose", pose_numbers(view.view.world_from_sensor)}});
}

void SessionPage::add_result(const LiveRun::Json& report) {
  const std::lock_guard lock(mutex_);
  is_finished_ = true;
  LiveRun::Json result = LiveRun::Json::object();
  for (const char* key : {"cloud", "mesh"}) result[key] = report.value(key, LiveRun::Json());
  run_.add("result", result);
  run_.add("state", {{"state", "finished"},
                     {"stop_reason", report.value("stop_reason", "")},
                     {"summary", report.value("summary", LiveRun::Json())}});
}

}  // namespace vantage
