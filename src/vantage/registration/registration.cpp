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

/// Cells of the levels, coarse to fine, each half the one before.
std::vector<double> cells(const Scale& scale, const RegistrationOptions& options) {
  const double finest = options.finest_cell_in_spacings * scale.spacing;
  std::vector<double> cells{finest};
  while (cells.front() < scale.search_radius / 4) cells.insert(cells.begin(), 2 * cells.front());
  return cells;
}

/// The believed pose and poses shifted from it by half the search radius along the axes.
std::vector<Pose> starts(const Pose& believed, double search_radius) {
  std::vector<Pose> poses{believed};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Pose shifted = believed;
      shifted.translation()[axis] += sign * search_radius / 2;
      poses.push_back(shifted);
    }
  }
  return poses;
}

struct Hypothesis {
  IcpResult result;
  double score = 0;
};

class Search {
 public:
  Search(const ModelSurface& model, const PointCloud& scan, const Pose& believed, const RegistrationOptions& options)
      : believed_(believed), options_(options), scale_(scale_of(scan, believed, options)) {
    for (const double cell : cells(scale_, options)) levels_.emplace_back(model.cloud(), scan, cell);
  }

  [[nodiscard]] Registration run() const {
    const std::vector<Hypothesis> ranked = coarse_hypotheses();
    Hypothesis best = refine(ranked.front().result);
    double rival = 0;
    for (std::size_t i = 1; i < ranked.size(); ++i) {
      Hypothesis other = refine(ranked[i].result);
      if (other.score > best.score) std::swap(best, other);
      if (differ(best, other)) rival = std::max(rival, other.score);
    }
    return judge(best, rival);
  }

 private:
  [[nodiscard]] IcpSettings settings(const IcpLevel& level, double max_distance_in_cells) const {
    return {.max_distance = max_distance_in_cells * level.cell(),
            .least_eigenvalue = options_.least_eigenvalue,
            .max_iterations = options_.max_iterations};
  }

  /// Poses from all starts at the coarsest level, best first, doubles left out.
  [[nodiscard]] std::vector<Hypothesis> coarse_hypotheses() const {
    const IcpLevel& level = levels_.front();
    std::vector<Hypothesis> found;
    for (const Pose& start : starts(believed_, scale_.search_radius)) {
      Hypothesis hypothesis{align(level, start, believed_, scale_.frame, settings(level, 4))};
      hypothesis.score = agreement(level, hypothesis.result.world_from_sensor).score;
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

  [[nodiscard]] Hypothesis refine(const IcpResult& coarse) const {
    Hypothesis hypothesis{coarse};
    for (std::size_t i = 1; i < levels_.size(); ++i) {
      hypothesis.result =
          align(levels_[i], hypothesis.result.world_from_sensor, believed_, scale_.frame, settings(levels_[i], 3));
    }
    hypothesis.score = agreement(levels_.back(), hypothesis.result.world_from_sensor).score;
    return hypothesis;
  }

  [[nodiscard]] double distance(const IcpResult& a, const IcpResult& b) const {
    return scale_.frame.step(a.world_from_sensor, b.world_from_sensor).norm();
  }
  [[nodiscard]] bool differ(const Hypothesis& a, const Hypothesis& b) const {
    return distance(a.result, b.result) > 2 * levels_.back().cell();
  }

  [[nodiscard]] Registration judge(const Hypothesis& best, double rival) const {
    const Agreement fit = agreement(levels_.back(), best.result.world_from_sensor);
    Registration registration{.world_from_sensor = best.result.world_from_sensor,
                              .overlap = fit.overlap,
                              .residual = fit.residual,
                              .undetermined_directions = best.result.undetermined_directions,
                              .explanation = {}};
    const double open_resistance = resistance_to_undetermined(
        best.result.equations, resistance(levels_.back(), best.result.world_from_sensor, scale_.frame),
        options_.least_eigenvalue);
    const double limit = options_.largest_residual_in_spacings * scale_.spacing;
    if (fit.overlap < options_.least_overlap) {
      registration.verdict = Verdict::insufficient_overlap;
      registration.explanation = concat(percent(fit.overlap), " % of the scan lies on the model; at least ",
                                        percent(options_.least_overlap), " % must");
    } else if (!best.result.converged) {
      registration.verdict = Verdict::not_converged;
      registration.explanation = concat("the pose still moved after ", options_.max_iterations, " iterations");
    } else if (fit.residual > limit) {
      registration.verdict = Verdict::large_residual;
      registration.explanation = concat("the overlap lies ", millimetres(fit.residual),
                                        " mm (RMS) off the model; at most ", millimetres(limit), " mm may be");
    } else if (open_resistance >= options_.least_eigenvalue) {
      registration.verdict = Verdict::degenerate;
      registration.explanation =
          concat("the overlap leaves ", best.result.undetermined_directions,
                 " directions open in which model and scan would not fit each other if they were off");
    } else if (rival > options_.ambiguity * best.score) {
      registration.verdict = Verdict::ambiguous;
      registration.explanation = concat("another pose fits ", percent(rival / best.score), " % as well");
    } else {
      registration.verdict = Verdict::registered;
      registration.explanation = concat(percent(fit.overlap), " % of the scan lies on the model, ",
                                        millimetres(fit.residual), " mm (RMS) off it");
      if (best.result.undetermined_directions > 0) {
        registration.explanation += concat("; ", best.result.undetermined_directions,
                                           " directions are not determined by the shape and stay as believed");
      }
    }
    return registration;
  }

  Pose believed_;
  RegistrationOptions options_;
  Scale scale_;
  std::vector<IcpLevel> levels_;
};

}  // namespace

void RegistrationOptions::validate() const {
  require(!spacing || *spacing > 0, "spacing = ", spacing.value_or(0), " m: must be positive");
  require(!search_radius || *search_radius > 0, "search_radius = ", search_radius.value_or(0), " m: must be positive");
  require(finest_cell_in_spacings >= 1, "finest_cell_in_spacings = ", finest_cell_in_spacings, ": must be at least 1");
  require(max_iterations > 0, "max_iterations = ", max_iterations, ": must be positive");
  require(least_overlap > 0 && least_overlap <= 1, "least_overlap = ", least_overlap, ": must be in (0, 1]");
  require(largest_residual_in_spacings > 0, "largest_residual_in_spacings = ", largest_residual_in_spacings,
          ": must be positive");
  require(least_eigenvalue > 0 && least_eigenvalue < 1, "least_eigenvalue = ", least_eigenvalue, ": must be in (0, 1)");
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
    case Verdict::ambiguous:
      return "ambiguous";
  }
  return "unknown";
}

Registration register_scan(const ModelSurface& model, const PointCloud& scan_in_sensor,
                           const Pose& believed_world_from_sensor, const RegistrationOptions& options) {
  options.validate();
  constexpr std::size_t least_points = 50;
  if (scan_in_sensor.size() < least_points || model.cloud().size() < least_points) {
    return {.world_from_sensor = believed_world_from_sensor,
            .verdict = Verdict::insufficient_overlap,
            .explanation = concat("the scan has ", scan_in_sensor.size(), " points and the model ",
                                  model.cloud().size(), "; both need ", least_points)};
  }
  return Search(model, scan_in_sensor, believed_world_from_sensor, options).run();
}

}  // namespace vantage
