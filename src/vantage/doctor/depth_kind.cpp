#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/doctor/consistency.hpp"
#include "vantage/doctor/hypothesis.hpp"

namespace vantage {
namespace {

constexpr double nearest = 0.05, farthest = 30;  // metres: the median depths that are tried for disparities

/// The constant with which disparities fit best: first in steps of a sixth, then finer.
double fitting_constant(const Evidence& evidence, Reading reading, double median_value) {
  const auto misfit_with = [&](double constant, double reach) {
    reading.depth_scale = constant;
    return misfit(evidence, reading, reach);
  };
  double best = 0, least = 2;
  for (double depth = nearest; depth < farthest; depth *= 1.16) {
    const double found = misfit_with(depth * median_value, 0.1);
    if (found >= least) continue;
    least = found;
    best = depth * median_value;
  }
  for (double step = 0.08; step > 0.001; step /= 2) {
    const double reach = std::max(0.02, step);
    least = misfit_with(best, reach);
    for (const double factor : {1 - step, 1 + step}) {
      const double constant = best * factor;
      const double found = misfit_with(constant, reach);
      if (found >= least) continue;
      least = found;
      best = constant;
    }
  }
  return best;
}

}  // namespace

std::vector<Hypothesis> distances(const Reading& base, const Evidence& evidence) {
  if (!evidence.camera || base.kind != DepthKind::depth) return {};
  Hypothesis along{"depth-kind", "the depths are distances along the ray of each pixel, not along the viewing axis",
                   "give --depth-along ray", base};
  along.reading.kind = DepthKind::distance;
  return {along};
}

std::vector<Hypothesis> disparities(const Reading& base, const Evidence& evidence) {
  const double median = evidence.median_depth();
  if (!evidence.camera || base.kind != DepthKind::depth || median <= 0) return {};
  Hypothesis each{"depth-kind", "the images hold disparities, not depths: the larger a value, the nearer", {}, base};
  each.reading.kind = DepthKind::disparity;
  each.reading.depth_scale = fitting_constant(evidence, each.reading, median);
  each.fix = concat("convert them: depth = focal length x baseline / disparity; by the frames about ",
                    each.reading.depth_scale, " m / value, where the value is what is now read as metres");
  return {each};
}

}  // namespace vantage
