#include <array>
#include <utility>

#include "vantage/core/error.hpp"
#include "vantage/doctor/hypothesis.hpp"

namespace vantage {
namespace {

// What sensors of objects measure; in a wrong unit depths seldom are.
constexpr double least_usual = 0.05, most_usual = 30;  // metres

bool is_usual(double depth) { return depth > least_usual && depth < most_usual; }

double median_depth(const Reading& base, const Evidence& evidence) {
  return base.depth_of(evidence.median_depth(), Eigen::Vector2d::Zero());
}

}  // namespace

std::vector<Hypothesis> depth_units(const Reading& base, const Evidence& evidence, double depth_scale) {
  // Powers of ten, and the 0.2 mm of the TUM sets against 1 mm and 0.1 mm.
  constexpr double factors[]{1e-4, 1e-3, 0.01, 0.1, 0.2, 0.5, 2, 5, 10, 100, 1e3, 1e4};
  std::vector<Hypothesis> hypotheses;
  if (base.kind == DepthKind::disparity) return hypotheses;
  const double median = median_depth(base, evidence);
  for (const double factor : factors) {
    if (!is_usual(factor * median)) continue;
    Hypothesis each{"depth-unit", {}, {}, base};
    each.reading.depth_scale = base.depth_scale * factor;
    if (evidence.camera) {
      each.wrong = concat("the depths are in the wrong unit: read with ", depth_scale, " m per unit, but they are ",
                          depth_scale * factor, " m per unit");
      each.fix = concat("give --depth-scale ", depth_scale * factor);
    } else {
      each.wrong = concat("the clouds are in another unit than the poses: ", factor, " times that");
      each.fix = concat("multiply the points of the clouds by ", factor);
    }
    hypotheses.push_back(std::move(each));
  }
  return hypotheses;
}

std::vector<Hypothesis> position_units(const Reading& base, const Evidence& evidence) {
  constexpr std::array<std::pair<const char*, double>, 3> units{{{"mm", 0.001}, {"cm", 0.01}, {"inch", 0.0254}}};
  std::vector<Hypothesis> hypotheses;
  if (!is_usual(median_depth(base, evidence))) return hypotheses;
  for (const auto& [unit, metres] : units) {
    Hypothesis each{"position-unit", {}, {}, base};
    for (Pose& pose : each.reading.world_from_sensor) pose.translation() *= metres;
    each.wrong = concat("the positions of the poses are in ", unit, ", not in metres");
    each.fix = evidence.camera ? concat("give --unit ", unit, " (it is that of floating-point depths, too)")
                               : concat("write the positions in metres: multiply them by ", metres);
    hypotheses.push_back(std::move(each));
  }
  return hypotheses;
}

}  // namespace vantage
