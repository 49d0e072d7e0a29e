#include "vantage/recordings/transform_tree.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vantage {
namespace {

constexpr std::size_t deepest = 100;  // of a tree of frames; deeper ones go round in circles

}  // namespace

std::optional<std::uint32_t> TransformTree::Edge::parent() const {
  if (moving.size() > 0) return moving.last_parent();
  return fixed ? std::optional(fixed->parent) : std::nullopt;
}

std::uint32_t TransformTree::number(const std::string& frame) {
  const auto [found, is_new] = numbers_.emplace(frame, static_cast<std::uint32_t>(names_.size()));
  if (is_new) {
    names_.push_back(frame);
    edges_.emplace_back();
  }
  return found->second;
}

void TransformTree::add(const RosPose& transform, std::int64_t time_ns) {
  const std::uint32_t parent = number(transform.header.frame_id), child = number(transform.child);
  edges_[child].moving.add(time_ns, parent, transform.parent_from_child);
}

void TransformTree::add_static(const RosPose& transform) {
  const std::uint32_t parent = number(transform.header.frame_id), child = number(transform.child);
  edges_[child].fixed = PoseTrack::Sample{0, parent, transform.parent_from_child.translation(),
                                          Eigen::Quaterniond(transform.parent_from_child.linear())};
}

void TransformTree::finish() {
  for (Edge& edge : edges_) edge.moving.finish();
}

std::vector<std::uint32_t> TransformTree::ancestors(std::uint32_t frame) const {
  std::vector<std::uint32_t> found{frame};
  while (found.size() < deepest) {
    const std::optional<std::uint32_t> parent = edges_[found.back()].parent();
    if (!parent) break;
    found.push_back(*parent);
  }
  return found;
}

std::optional<std::string> TransformTree::root_of(const std::string& frame) const {
  const auto known = numbers_.find(frame);
  if (known == numbers_.end()) return std::nullopt;
  return names_[ancestors(known->second).back()];
}

bool TransformTree::moves(const std::string& frame) const {
  const auto known = numbers_.find(frame);
  if (known == numbers_.end()) return false;
  const std::vector<std::uint32_t> chain = ancestors(known->second);
  return std::any_of(chain.begin(), chain.end(), [&](std::uint32_t each) { return edges_[each].moving.moves(); });
}

TransformTree::Chain TransformTree::chain(std::uint32_t frame, std::int64_t time_ns) const {
  Chain chain{{{frame, Pose::Identity()}}, {}};
  while (chain.steps.size() < deepest) {
    const Step& below = chain.steps.back();
    const Edge& edge = edges_[below.frame];
    std::optional<PoseTrack::Sample> sample = edge.fixed;
    if (edge.moving.size() > 0) {
      auto [moving, reason] = edge.moving.at(time_ns);
      if (!moving) {
        chain.reason = fmt::format("/tf of {}: {}", names_[below.frame], reason);
        return chain;
      }
      sample = moving;
    }
    if (!sample) return chain;
    chain.steps.push_back({sample->parent, sample->pose() * below.frame_from_start});
  }
  chain.reason = fmt::format("the frames above {} go round in a circle", names_[frame]);
  return chain;
}

PoseOrReason TransformTree::a_from_b(const std::string& a, const std::string& b, std::int64_t time_ns) const {
  for (const std::string& frame : {a, b}) {
    if (!knows(frame)) return {std::nullopt, fmt::format("/tf has no frame {}", frame)};
  }
  const Chain from_a = chain(numbers_.at(a), time_ns), from_b = chain(numbers_.at(b), time_ns);
  for (const Step& step : from_b.steps) {
    for (const Step& other : from_a.steps) {
      if (step.frame == other.frame) return {other.frame_from_start.inverse() * step.frame_from_start, ""};
    }
  }
  if (!from_b.reason.empty()) return {std::nullopt, from_b.reason};
  if (!from_a.reason.empty()) return {std::nullopt, from_a.reason};
  return {std::nullopt, fmt::format("/tf does not connect {} and {}", a, b)};
}

void TransformTree::draw(std::uint32_t frame, std::size_t depth, std::vector<std::string>& lines) const {
  const Edge& edge = edges_[frame];
  std::string note;
  if (edge.moving.size() > 0) {
    const double duration = edge.moving.duration_s();
    note = fmt::format("  {} poses", edge.moving.size());
    if (duration > 0) note += fmt::format(", {:.1f} Hz", static_cast<double>(edge.moving.size() - 1) / duration);
  } else if (edge.fixed) {
    note = "  static";
  }
  lines.push_back(std::string(2 * depth, ' ') + names_[frame] + note);
  if (depth >= deepest) return;
  for (const auto& [name, child] : numbers_) {
    if (edges_[child].parent() == frame && child != frame) draw(child, depth + 1, lines);
  }
}

std::vector<std::string> TransformTree::drawing() const {
  std::vector<std::string> lines;
  for (const auto& [name, frame] : numbers_) {
    if (!edges_[frame].parent()) draw(frame, 0, lines);
  }
  return lines;
}

}  // namespace vantage
