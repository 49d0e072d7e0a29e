#include "vantage/session/session_model.hpp"

#include <utility>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

/// Gives back what was found before of the first scan that it is asked about, or else asks another registrar; and keeps
/// what it answered.
class KeepingRegistrar : public Registrar {
 public:
  KeepingRegistrar(Registrar& registrar, std::optional<Located> known)
      : registrar_(registrar), known_(std::move(known)) {}
  [[nodiscard]] Located locate(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                               const View& believed) override {
    const std::optional<Located> known = std::exchange(known_, std::nullopt);
    return kept(known ? with_surface(*known, scan, points, believed)
                      : registrar_.locate(model, scan, points, believed));
  }
  [[nodiscard]] Located locate_from(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                                    const PoseEstimate& estimate) override {
    const std::optional<Located> known = std::exchange(known_, std::nullopt);
    return kept(known ? with_surface(*known, scan, points, View{estimate.mean})
                      : registrar_.locate_from(model, scan, points, estimate));
  }
  [[nodiscard]] PoseEstimate prior(const ModelSurface& model, const View& believed) override {
    return registrar_.prior(model, believed);
  }
  [[nodiscard]] std::shared_ptr<const ScanSurface> surface_of(const Scan& scan, const PointCloud& points,
                                                              const View& believed) const override {
    return registrar_.surface_of(scan, points, believed);
  }
  void believe(const PoseError& error) override { registrar_.believe(error); }
  [[nodiscard]] bool estimates() const override { return registrar_.estimates(); }
  /// The first answer.
  [[nodiscard]] const Located& found() const { return found_; }

 private:
  [[nodiscard]] Located with_surface(Located located, const Scan& scan, const PointCloud& points,
                                     const View& believed) const {
    located.surface = registrar_.surface_of(scan, points, believed);
    return located;
  }
  [[nodiscard]] Located kept(Located located) {
    if (!has_answered_) found_ = located;
    has_answered_ = true;
    return located;
  }

  Registrar& registrar_;
  std::optional<Located> known_;
  Located found_;
  bool has_answered_ = false;
};

}  // namespace

SessionModel::SessionModel(const ScanPlanningOptions& options)
    : given_radius_(options.scene.radius),
      views_(options.scene.views),
      box_(session_box(options)),
      registrar_(make_registrar(options.scene, scene_in(box_, options.scene))),
      scans_(scene_in(box_, options.scene)) {
  if (const auto learner = options.planning.learner_options()) scans_.learner.emplace(*learner);
}

Located SessionModel::add(int number, const SessionScan& scan, const std::optional<Located>& known) {
  KeepingRegistrar registrar(*registrar_, known);
  const ScanOrigin origin{scan.name, scan.candidate.value_or(-1), commanded(scan)};
  const ScanRecord& record = scans_.add(origin, scan.scan, scan.believed, registrar);
  note_candidate(scan, record);
  numbers_.push_back(number);
  if (record.merged && !box_was_seen_) box_was_seen_ = points_in(box_, scan.scan, record.registered) > 0;
  const auto* image = std::get_if<ImageScan>(&scan.scan);
  if (image != nullptr && !camera_) camera_ = image->image.camera;
  return registrar.found();
}

std::optional<View> SessionModel::commanded(const SessionScan& scan) const {
  if (scan.commanded || !scan.candidate || *scan.candidate >= views_ || radius() == 0) return scan.commanded;
  return view_sphere(views_, radius(), box_.center()).views[static_cast<std::size_t>(*scan.candidate)];
}

void SessionModel::note_candidate(const SessionScan& scan, const ScanRecord& record) {
  if (record.merged) {
    set_aside_.clear();
  } else if (scan.candidate) {
    set_aside_[*scan.candidate] = concat("its scan could not be registered: ", record.verdict);
  }
}

double SessionModel::radius() const { return given_radius_ ? *given_radius_ : scans_.sensor_distance(); }

SessionState SessionModel::state() const {
  return {.map = model().map,
          .scans = model().scans,
          .numbers = numbers_,
          .current = scans_.current(),
          .radius = radius(),
          .camera = camera_,
          .set_aside = set_aside_,
          .box_was_seen = box_was_seen_,
          .sensor = model().sensor,
          .learner = scans_.learner};
}

Box3 session_box(const ScanPlanningOptions& options) {
  const std::optional<Box3> box = given_box(options.scene);
  require(
      box.has_value(),
      "box: a session needs cx,cy,cz,sx,sy,sz; its scans come one by one, so that the box cannot be found from them");
  return box.value_or(Box3());
}

Planner session_planner(const ScanPlanningOptions& options, const SessionState& state,
                        const std::map<int, std::string>& skipped) {
  const Vec3 center = session_box(options).center();
  Planner planner = options.planner(view_sphere(options.scene.views, state.radius, center), state.camera);
  tell_of_scans(planner, state.scans);
  if (state.learner) planner.believe(state.learner->prediction());
  for (const auto& [candidate, reason] : state.set_aside) planner.set_aside(candidate, reason);
  for (const auto& [candidate, reason] : skipped) planner.discard(candidate, reason);
  return planner;
}

}  // namespace vantage
