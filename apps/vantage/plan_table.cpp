#include "plan_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <regex>

#include "notes.hpp"
#include "vantage/files/plain_text.hpp"
#include "vantage/runs/run_files.hpp"

namespace vantage::app {
namespace {

std::string expectation_text(const Expectation& expected) {
  return fmt::format(" {:>8.5f} {:>7.0f} %", expected.utility, 100 * expected.registers);
}

/// The reason with "…" for each number in it.
std::string kind_of(const std::string& reason) {
  static const std::regex number(R"((^|[ (,])-?[0-9][0-9.e+-]*(,-?[0-9][0-9.e+-]*)*)");
  return std::regex_replace(reason, number, "$1…");
}

}  // namespace

std::vector<std::string> infeasible_by_reason(const std::vector<Evaluation>& evaluations) {
  struct Kind {
    std::string text, first;  // of the kind, and of the first view that has it
    int views = 0;
  };
  std::vector<Kind> kinds;
  for (const Evaluation& each : evaluations) {
    if (each.feasible) continue;
    const std::string text = kind_of(each.reason);
    const auto same = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& kind) { return kind.text == text; });
    Kind& kind = same != kinds.end() ? *same : kinds.emplace_back(Kind{text, each.reason, 0});
    ++kind.views;
    if (each.reason != kind.first) kind.first = kind.text;
  }
  std::stable_sort(kinds.begin(), kinds.end(), [](const Kind& a, const Kind& b) { return a.views > b.views; });
  std::vector<std::string> lines;
  for (const Kind& kind : kinds)
    lines.push_back(fmt::format("{} of {}: {}", kind.views, evaluations.size(), kind.first));
  return lines;
}

void print_views(std::vector<Evaluation> evaluations, const PlanTableOptions& options) {
  rank(evaluations);
  const bool is_expected = std::any_of(evaluations.begin(), evaluations.end(),
                                       [](const Evaluation& each) { return each.expected.has_value(); });
  fmt::print("{:>5} {:>24} {:>6} {:>6} {:>6} {:>7} {:>7} {:>7} {:>7} {:>8}{}\n", "view", "position [m]", "n_oc", "n_op",
             "n_um", "f_area", "f_nav", "f_qual", "f_occl", "utility", is_expected ? " expected registers" : "");
  int printed = 0;
  for (const Evaluation& e : evaluations) {
    if (!e.feasible) continue;
    if (++printed > options.top) break;
    const Vec3 p = e.view.position();
    fmt::print("{:>5} {:>24} {:>6} {:>6} {:>6} {:>7.4f} {:>7.4f} {:>7.4f} {:>7.4f} {:>8.5f}{}\n", e.candidate,
               fmt::format("{:.3f} {:.3f} {:.3f}", p.x(), p.y(), p.z()), e.seen.occupied, e.seen.occplane,
               e.seen.unmarked, e.factors.f_area, e.factors.f_navigation, e.factors.f_quality, e.factors.f_occlusion,
               e.utility, e.expected ? expectation_text(*e.expected) : "");
  }
  if (options.verbose) {
    for (const Evaluation& e : evaluations) {
      if (!e.feasible) fmt::print("{:>5} not feasible: {}\n", e.candidate, printable(e.reason));
    }
    return;
  }
  const std::vector<std::string> infeasible = infeasible_by_reason(evaluations);
  if (!infeasible.empty()) fmt::print("not feasible (--verbose lists each view):\n");
  for (const std::string& line : infeasible) fmt::print("  {}\n", printable(line));
}

void print_scan_set(const ScanSet& set) {
  if (!set.description.empty()) print_note("{}\n", printable(set.description));
  constexpr std::size_t most = 20;
  for (std::size_t i = 0; i < std::min(most, set.left_out.size()); ++i)
    print_note("left out: {}\n", printable(set.left_out[i]));
  if (set.left_out.size() > most) print_note("left out: {} more\n", set.left_out.size() - most);
}

std::string record_line(const ScanRecord& record) {
  // Why a scan was refused, and which directions stay as believed.
  const bool has_more = !record.merged || record.undetermined_directions > 0;
  const std::string more = has_more ? fmt::format("{:<24} {}\n", "", printable(record.detail)) : "";
  return fmt::format(
      "{:<24} {:<20} overlap {:>5.1f} %  residual {:>6.2f} mm  moved {:>5.1f} mm {:>4.1f} deg  {:>5} new voxels"
      "{:>5} taken back  {:>5} flying pixels{}\n{}",
      printable(record.reason), record.verdict, 100 * record.overlap, 1000 * record.residual,
      1000 * (record.registered.position() - record.believed.position()).norm(),
      degrees(rotation_angle(record.registered.world_from_sensor.linear(), record.believed.world_from_sensor.linear())),
      record.new_occupied, record.taken_back, record.flying, record.merged ? "" : "  NOT MERGED", more);
}

void print_move(const Move& move) {
  fmt::print("  the way there costs {:.3f} and has {} places:\n", move.cost, move.path.size());
  for (const RobotState& state : move.path) {
    const Vec3 at = state.view.position();
    fmt::print("    sensor at {:.3f} {:.3f} {:.3f}", at.x(), at.y(), at.z());
    if (state.joints.size() > 0) fmt::print(", joints");
    for (const double joint : state.joints) fmt::print(" {:.4f}", joint);
    fmt::print("\n");
  }
}

void print_tour(const std::vector<TourStop>& tour) {
  if (tour.empty()) return;
  fmt::print("  the rest of the scan, expected to end after {} views and {:.0f} s:\n", tour.size(),
             tour.back().seconds);
  for (const TourStop& stop : tour) {
    fmt::print("    view {:>4} after {:>6.1f} s: {:>5.1f} % of the expected surface\n", stop.candidate, stop.seconds,
               100 * stop.covered);
  }
}

void print_plan(const std::optional<Plan>& plan, const std::string& why_finished, const PlanTableOptions& options) {
  if (!plan) {
    fmt::print("nothing left to plan: {}\n", printable(why_finished));
    return;
  }
  const std::array<double, 7> pose = pose_numbers(plan->best.view.world_from_sensor);
  fmt::print("next best view: {}\n  {}\n", plan->best.candidate, plan->explanation);
  fmt::print("  pose (x y z qx qy qz qw, world from sensor): {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}\n",
             pose[0], pose[1], pose[2], pose[3], pose[4], pose[5], pose[6]);
  if (plan->move.possible()) print_move(plan->move);
  print_tour(plan->tour);
  fmt::print("\n");
  std::vector<Evaluation> all = plan->ranking;
  all.insert(all.end(), plan->infeasible.begin(), plan->infeasible.end());
  print_views(all, options);
}

}  // namespace vantage::app
