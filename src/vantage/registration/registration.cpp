#include "vantage/registration/registration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vantage/core/error.hpp"
#include "vantage/registration/icp.hpp"

namespace vantage {
namespace {

/// For sentences: a share in per cent and a length in millimetres, rounded to what people read.
double percent(double share) { return std::round(1e3 * share) / 10; }
double millimetres(double metres) { return std::round(1e5 * metres) / 100; }

struct Scale {
  double spacing = 0;        // m
  double search_radius = 0;  // m
  MotionFrame frame;         // about the scan's middle at the believed pose
};

Scale scale_of(const PointCloud& scan, const Pose& believed, const RegistrationOptions& options) {
  Box3 box;
  for (const Vec3& point : scan.points) box.extend(point);
  Scale scale;
  scale.spacing = options.spacing ? *options.spacing : point_spacing(PointIndex(scan.points));
  scale.search_radius = options.search_radius ? *options.search_radius : box.sizes().maxCoeff() / 5;
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : scan.points) sum += point;
  const Vec3 middle = sum / static_cast<double>(scan.size());
  double squares = 0;
  for (const Vec3& point : scan.points) squares += (point - middle).squaredNorm();
  scale.frame = {.center = believed * middle, .length = std::sqrt(squares / static_cast<double>(scan.size()))};
  return scale;
}

/// Cells of the levels, coarse to fine, each half the one before. The finest is the smallest in which the scan shows a
/// surface rather than its noise.
std::vector<double> cells(const PointCloud& scan, const Scale& scale, const RegistrationOptions& options) {
  constexpr double least_flat_share = 0.5;
  double finest = options.finest_cell_in_spacings * scale.spacing;
  while (2 * finest < scale.search_radius / 4 && make_surfels(scan, finest).flat_share() < least_flat_share) {
    finest *= 2;
  }
  std::vector<double> cells{2 * finest, finest};  // at least one to search on and one to finish on
  while (cells.front() < scale.search_radius / 4) cells.insert(cells.begin(), 2 * cells.front());
  return cells;
}

struct Hypothesis {
  IcpResult result;
  double score = 0;
};

/// What range images say about empty space at any pose of the scan.
class FreeSpaceCheck {
 public:
  FreeSpaceCheck(const ModelSurface& model, const PointCloud& scan, const RangeImage* image, double margin)
      : model_(evenly_picked(model.cloud().points)), scan_(evenly_picked(scan.points)) {
    for (const PosedImage& seen : model.images()) {
      before_.emplace_back(seen.image, margin);
      poses_.push_back(seen.world_from_sensor);
    }
    if (image != nullptr) now_.emplace(*image, margin);
  }

  /// The largest share of the scan's points in the free space of one earlier image, or of the model's points in that of
  /// the scan's own image.
  [[nodiscard]] double share(const Pose& world_from_sensor) const {
    double largest = now_ ? now_->share_inside(model_, world_from_sensor) : 0;
    for (std::size_t i = 0; i < before_.size(); ++i) {
      largest = std::max(largest, before_[i].share_inside(scan_, world_from_sensor.inverse() * poses_[i]));
    }
    return largest;
  }

 private:
  // Five thousand points measure a share of one per cent within a seventh of it.
  static std::vector<Vec3> evenly_picked(std::span<const Vec3> points) {
    const std::size_t step = points.size() / 5000 + 1;
    std::vector<Vec3> picked;
    for (std::size_t i = 0; i < points.size(); i += step) picked.push_back(points[i]);
    return picked;
  }

  std::vector<Vec3> model_, scan_;
  std::vector<FreeSpace> before_;
  std::vector<Pose> poses_;
  std::optional<FreeSpace> now_;
};

class Search {
 public:
  Search(const ModelSurface& model, const PointCloud& scan, const RangeImage* image, const Pose& believed,
         const RegistrationOptions& options)
      : believed_(believed),
        options_(options),
        scale_(scale_of(scan, believed, options)),
        cells_(cells(scan, scale_, options)),
        free_space_(model, scan, image, free_space_margin_in_cells * cells_.back()) {
    for (const double cell : cells_) levels_.emplace_back(model.cloud(), scan, cell);
  }

  [[nodiscard]] Registration run() const {
    std::vector<Hypothesis> hypotheses = coarse_hypotheses();
    for (Hypothesis& hypothesis : hypotheses) refine(hypothesis);
    const auto by_score = [](const Hypothesis& a, const Hypothesis& b) { return a.score < b.score; };
    Hypothesis best = *std::max_element(hypotheses.begin(), hypotheses.end(), by_score);
    double rival = 0;  // score of the best of the hypotheses that are not the best one's twins
    for (const Hypothesis& other : hypotheses) {
      if (distance(best.result, other.result) > 4 * cells_.back()) rival = std::max(rival, other.score);
    }
    const double rival_share = best.score > 0 ? rival / best.score : 1;
    best.result = align(levels_.back(), best.result.world_from_sensor, believed_, scale_.frame, last_settings());
    return judge(best.result, rival_share);
  }

 private:
  // Distance that points keep from measured surfaces before they count as standing in free space.
  static constexpr double free_space_margin_in_cells = 2;

  [[nodiscard]] IcpSettings settings(const IcpLevel& level, double max_distance_in_cells) const {
    IcpSettings settings{.max_distance = max_distance_in_cells * level.cell(),
                         .least_resistance = options_.least_resistance,
                         .max_iterations = options_.max_iterations};
    if (options_.trust > 0) {
      settings.trust = options_.trust;
      settings.farthest = farthest();
      settings.cost = believed_errors().cwiseAbs2().cwiseInverse();
    }
    return settings;
  }

  [[nodiscard]] IcpSettings last_settings() const {
    IcpSettings last = settings(levels_.back(), 3);
    if (options_.trust > 0) last.trust = options_.trust_at_last.value_or(options_.trust);
    return last;
  }

  /// The believed pose and, unless it is trusted, poses shifted from it by half the search radius along the axes.
  [[nodiscard]] std::vector<Pose> starts() const {
    std::vector<Pose> poses{believed_};
    if (options_.trust > 0) return poses;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        Pose shifted = believed_;
        shifted.translation()[axis] += sign * scale_.search_radius / 2;
        poses.push_back(shifted);
      }
    }
    return poses;
  }

  /// Poses from all starts at the coarsest level, best first, doubles left out.
  [[nodiscard]] std::vector<Hypothesis> coarse_hypotheses() const {
    const IcpLevel& level = levels_.front();
    std::vector<Hypothesis> found;
    for (const Pose& start : starts()) {
      Hypothesis hypothesis{align(level, start, believed_, scale_.frame, settings(level, 4))};
      hypothesis.score = score(level, hypothesis.result.world_from_sensor);
      const auto twin = [&](const Hypothesis& other) {
        return distance(hypothesis.result, other.result) < 0.5 * level.cell();
      };
      if (std::none_of(found.begin(), found.end(), twin)) found.push_back(hypothesis);
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
    constexpr std::size_t most = 3;
    if (found.size() > most) found.resize(most);
    return found;
  }

  /// Follows a hypothesis through all levels but the finest.
  void refine(Hypothesis& hypothesis) const {
    for (std::size_t i = 1; i + 1 < levels_.size(); ++i) {
      hypothesis.result =
          align(levels_[i], hypothesis.result.world_from_sensor, believed_, scale_.frame, settings(levels_[i], 3));
      hypothesis.score = score(levels_[i], hypothesis.result.world_from_sensor);
    }
  }

  /// Share of the scan on the model, less what is in free space; -1 where the pose is implausibly far off.
  [[nodiscard]] double score(const IcpLevel& level, const Pose& world_from_sensor) const {
    if (moved(world_from_sensor) > farthest()) return -1;
    return agreement(level, world_from_sensor).score - free_space_.share(world_from_sensor);
  }

  [[nodiscard]] double distance(const IcpResult& a, const IcpResult& b) const {
    return scale_.frame.step(a.world_from_sensor, b.world_from_sensor).norm();
  }

  /// RMS distance between the scan's points at a pose and at the believed one.
  [[nodiscard]] double moved(const Pose& world_from_sensor) const {
    return scale_.frame.step(believed_, world_from_sensor).norm();
  }
  /// A motion beyond four and a half standard deviations of the believed position is a wrong match.
  [[nodiscard]] double farthest() const { return 1.5 * scale_.search_radius; }

  /// Standard deviations of the believed pose, as a step.
  [[nodiscard]] Vec6 believed_errors() const {
    Vec6 errors;
    errors << Vec3::Constant(scale_.search_radius / 3),
        Vec3::Constant(options_.orientation_error * scale_.frame.length);
    return errors;
  }

  [[nodiscard]] Registration judge(const IcpResult& result, double rival_share) const {
    const Agreement fit = agreement(levels_.back(), result.world_from_sensor);
    Registration registration{.world_from_sensor = result.world_from_sensor,
                              .overlap = fit.overlap,
                              .residual = fit.residual,
                              .undetermined_directions = result.directions.open_count(),
                              .explanation = {}};
    const double cell = levels_.back().cell();
    const double limit = options_.largest_residual_in_cells * cell;
    const double may_be_off = misfit_of_open_directions(levels_.back(), result, scale_.frame, believed_errors());
    const double in_free_space = free_space_.share(result.world_from_sensor);
    const auto refuse = [&](Verdict verdict, const auto&... parts) {
      registration.verdict = verdict;
      registration.explanation = concat(parts...);
      return registration;
    };
    if (fit.overlap < options_.least_overlap) {
      return refuse(Verdict::insufficient_overlap, percent(fit.overlap), " % of the scan lies on the model; at least ",
                    percent(options_.least_overlap), " % must");
    }
    if (!result.converged) {
      return refuse(Verdict::not_converged, "the pose still moved after ", options_.max_iterations, " iterations");
    }
    if (const double distance_moved = moved(result.world_from_sensor); distance_moved > farthest()) {
      return refuse(Verdict::not_converged, "the pose ended ", millimetres(distance_moved),
                    " mm from the believed one; at most ", millimetres(farthest()), " mm are plausible");
    }
    if (fit.residual > limit) {
      return refuse(Verdict::large_residual, "the overlap lies ", millimetres(fit.residual),
                    " mm (RMS) off the model; at most ", millimetres(limit), " mm may be");
    }
    if (may_be_off > options_.largest_open_misfit.value_or(cell)) {
      return refuse(Verdict::degenerate, "the overlap leaves ", registration.undetermined_directions,
                    " directions open in which the believed pose may put surfaces ", millimetres(may_be_off),
                    " mm off");
    }
    if (in_free_space > options_.largest_share_in_free_space) {
      return refuse(Verdict::in_free_space, percent(in_free_space),
                    " % of the points would stand where a range image looks through; at most ",
                    percent(options_.largest_share_in_free_space), " % may");
    }
    if (rival_share > options_.ambiguity) {
      return refuse(Verdict::ambiguous, "another pose fits ", percent(rival_share), " % as well");
    }
    registration.verdict = Verdict::registered;
    registration.explanation = concat(percent(fit.overlap), " % of the scan lies on the model, ",
                                      millimetres(fit.residual), " mm (RMS) off it");
    if (registration.undetermined_directions > 0) {
      registration.explanation += concat("; ", registration.undetermined_directions,
                                         " directions are not determined by the shape and stay as believed");
    }
    return registration;
  }

  Pose believed_;
  RegistrationOptions options_;
  Scale scale_;
  std::vector<double> cells_;  // of the levels
  FreeSpaceCheck free_space_;
  std::vector<IcpLevel> levels_;  // coarse to fine
};

Registration search(const ModelSurface& model, const PointCloud& scan, const RangeImage* image, const Pose& believed,
                    const RegistrationOptions& options) {
  options.validate();
  constexpr std::size_t least_points = 50;
  if (scan.size() < least_points || model.cloud().size() < least_points) {
    return {.world_from_sensor = believed,
            .verdict = Verdict::insufficient_overlap,
            .explanation = concat("the scan has ", scan.size(), " points and the model ", model.cloud().size(),
                                  "; both need ", least_points)};
  }
  return Search(model, scan, image, believed, options).run();
}

}  // namespace

void RegistrationOptions::validate() const {
  require(!spacing || *spacing > 0, "spacing = ", spacing.value_or(0), " m: must be positive");
  require(!search_radius || *search_radius > 0, "search_radius = ", search_radius.value_or(0), " m: must be positive");
  require(finest_cell_in_spacings >= 1, "finest_cell_in_spacings = ", finest_cell_in_spacings, ": must be at least 1");
  require(max_iterations > 0, "max_iterations = ", max_iterations, ": must be positive");
  require(least_overlap > 0 && least_overlap <= 1, "least_overlap = ", least_overlap, ": must be in (0, 1]");
  require(largest_residual_in_cells > 0, "largest_residual_in_cells = ", largest_residual_in_cells,
          ": must be positive");
  require(least_resistance > 0 && least_resistance < 1, "least_resistance = ", least_resistance, ": must be in (0, 1)");
  require(largest_share_in_free_space >= 0 && largest_share_in_free_space <= 1,
          "largest_share_in_free_space = ", largest_share_in_free_space, ": must be in [0, 1]");
  require(!largest_open_misfit || *largest_open_misfit > 0, "largest_open_misfit = ", largest_open_misfit.value_or(0),
          " m: must be positive");
  require(trust >= 0 && trust < 1, "trust = ", trust, ": must be in [0, 1)");
  require(!trust_at_last || (*trust_at_last >= 0 && *trust_at_last < 1), "trust_at_last = ", trust_at_last.value_or(0),
          ": must be in [0, 1)");
  require(orientation_error > 0, "orientation_error = ", orientation_error, " rad: must be positive");
  require(ambiguity > 0 && ambiguity <= 1, "ambiguity = ", ambiguity, ": must be in (0, 1]");
}

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::registered:
      return "registered";
    case Verdict::insufficient_overlap:
      return "insufficient overlap";
    case Verdict::not_converged:
      return "not converged";
    case Verdict::large_residual:
      return "large residual";
    case Verdict::degenerate:
      return "degenerate";
    case Verdict::in_free_space:
      return "in free space";
    case Verdict::ambiguous:
      return "ambiguous";
  }
  return "unknown";
}

Registration register_scan(const ModelSurface& model, const PointCloud& scan_in_sensor,
                           const Pose& believed_world_from_sensor, const RegistrationOptions& options) {
  return search(model, scan_in_sensor, nullptr, believed_world_from_sensor, options);
}

Registration register_scan(const ModelSurface& model, const PointCloud& scan_in_sensor, const RangeImage& image,
                           const Pose& believed_world_from_sensor, const RegistrationOptions& options) {
  return search(model, scan_in_sensor, &image, believed_world_from_sensor, options);
}

}  // namespace vantage
