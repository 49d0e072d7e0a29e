#include "vantage/core/error.hpp"
#include "vantage/doctor/hypothesis.hpp"

namespace vantage {

std::vector<Hypothesis> depth_units(const Reading& base, double depth_scale) {
  // Powers of ten, and the 0.2 mm of the TUM sets against 1 mm and 0.1 mm.
  constexpr double factors[]{1e-4, 1e-3, 0.01, 0.1, 0.2, 0.5, 2, 5, 10, 100, 1e3, 1e4};
  std::vector<Hypothesis> hypotheses;
  for (const double factor : factors) {
    Hypothesis each{"depth-unit", {}, {}, base};
    each.reading.depth_scale = base.depth_scale * factor;
    each.wrong = concat("the depths are in the wrong unit: read with ", depth_scale, " m per unit, but they are ",
                        depth_scale * factor, " m per unit");
    each.mend = concat("give --depth-scale ", depth_scale * factor,
                       " (for clouds, which are read in metres: scale their points by ", factor, ")");
    hypotheses.push_back(std::move(each));
  }
  return hypotheses;
}

}  // namespace vantage
