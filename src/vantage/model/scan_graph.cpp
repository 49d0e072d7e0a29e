#include "vantage/model/scan_graph.hpp"

#include <algorithm>
#include <limits>

namespace vantage {
namespace {

constexpr std::size_t recent = 12;          // scans that count as just taken
constexpr std::size_t asked_of_each = 6;    // recent ones, and older ones, that are asked how much they overlap
constexpr std::size_t paired = 5;           // with those that overlap most
constexpr double least_overlap = 0.1;       // share of samples
constexpr std::size_t most_surfaces = 100;  // that are kept to lay later scans on, so that memory is bounded

/// How alike two sensors see: the distance of their positions plus that of points a metre ahead.
double difference(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm() + (a * Vec3(0, 0, 1) - b * Vec3(0, 0, 1)).norm();
}

}  // namespace

std::vector<std::size_t> ScanGraph::neighbours(const PairedSurface& surface, const Pose& world_from_sensor) const {
  const std::size_t first_recent = scans_.size() - std::min(recent, scans_.size());
  std::vector<std::size_t> asked;
  for (const auto& [begin, end] : {std::pair{std::size_t{0}, first_recent}, {first_recent, scans_.size()}}) {
    std::vector<std::pair<double, std::size_t>> alike;
    for (std::size_t i = begin; i < end; ++i) {
      if (!scans_[i].surface) continue;
      alike.emplace_back(difference(scans_[i].world_from_sensor, world_from_sensor), i);
    }
    const std::size_t count = std::min(asked_of_each, alike.size());
    std::partial_sort(alike.begin(), alike.begin() + static_cast<std::ptrdiff_t>(count), alike.end());
    for (std::size_t i = 0; i < count; ++i) asked.push_back(alike[i].second);
  }
  std::vector<std::pair<double, std::size_t>> overlapping;
  for (const std::size_t i : asked) {
    const Scan& other = scans_[i];
    const double share = surface.overlap(*other.surface, other.world_from_sensor.inverse() * world_from_sensor);
    if (share >= least_overlap) overlapping.emplace_back(-share, i);
  }
  std::sort(overlapping.begin(), overlapping.end());
  if (overlapping.size() > paired) overlapping.resize(paired);
  std::vector<std::size_t> chosen;
  chosen.reserve(overlapping.size());
  for (const auto& [share, i] : overlapping) chosen.push_back(i);
  return chosen;
}

void ScanGraph::add(int number, const ScanSurface& surface, const PoseEstimate& prior, const Pose& world_from_sensor) {
  auto paired_surface = std::make_shared<const PairedSurface>(surface);
  const std::size_t here = scans_.size();
  for (const std::size_t i : neighbours(*paired_surface, world_from_sensor)) {
    const Scan& other = scans_[i];
    auto constraint =
        constraint_between(*other.surface, *paired_surface, other.world_from_sensor.inverse() * world_from_sensor,
                           {.least_overlap = least_overlap});
    if (!constraint) continue;
    constraint->from = i;
    constraint->to = here;
    constraints_.push_back(*constraint);
  }
  priors_.push_back({here, prior.mean, inverse_covariance(prior.covariance)});
  scans_.push_back({number, std::move(paired_surface), world_from_sensor});
  forget_a_surface();
}

void ScanGraph::forget_a_surface() {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    if (scans_[i].surface) kept.push_back(i);
  }
  if (kept.size() <= most_surfaces) return;
  // The later of the two that see most alike, but for those that were just taken.
  std::size_t redundant = kept.front();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a + recent < kept.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double between = difference(scans_[kept[a]].world_from_sensor, scans_[kept[b]].world_from_sensor);
      if (between < least) {
        least = between;
        redundant = kept[a];
      }
    }
  }
  scans_[redundant].surface.reset();
}

void ScanGraph::remove(int number) {
  const auto found =
      std::find_if(scans_.begin(), scans_.end(), [&](const Scan& scan) { return scan.number == number; });
  if (found == scans_.end()) return;
  const auto at = static_cast<std::size_t>(found - scans_.begin());
  const auto moved = [at](std::size_t i) { return i > at ? i - 1 : i; };
  std::erase_if(constraints_, [at](const PoseConstraint& c) { return c.from == at || c.to == at; });
  for (PoseConstraint& constraint : constraints_) {
    constraint.from = moved(constraint.from);
    constraint.to = moved(constraint.to);
  }
  std::erase_if(priors_, [at](const PosePrior& prior) { return prior.pose == at; });
  for (PosePrior& prior : priors_) prior.pose = moved(prior.pose);
  scans_.erase(found);
  size_at_last_ = std::min(size_at_last_, scans_.size());
}

bool ScanGraph::is_due() const {
  const std::size_t fresh = scans_.size() - size_at_last_;
  return fresh >= 4 && 4 * fresh >= scans_.size();
}

ScanGraph::Improved ScanGraph::improve() {
  size_at_last_ = scans_.size();
  PoseGraph graph;
  graph.priors = priors_;
  graph.constraints = constraints_;
  for (const Scan& scan : scans_) graph.poses.push_back(scan.world_from_sensor);
  const SolvedPoses solved = solve(graph);
  Improved improved;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    improved.world_from_sensor.emplace(scans_[i].number, solved.poses[i]);
    if (!scans_[i].surface) continue;
    improved.largest_move = std::max(
        improved.largest_move, scans_[i].surface->mean_displacement(scans_[i].world_from_sensor, solved.poses[i]));
  }
  return improved;
}

void ScanGraph::accept(const Improved& improved) {
  for (Scan& scan : scans_) scan.world_from_sensor = improved.world_from_sensor.at(scan.number);
}

}  // namespace vantage
