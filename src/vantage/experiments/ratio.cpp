#include "vantage/experiments/ratio.hpp"

#include "vantage/core/error.hpp"

namespace vantage {

Estimate ratio_of_means(const std::vector<double>& ours, const std::vector<double>& theirs) {
  const double mean = estimate(theirs).mean;
  require(mean != 0, "ratio of means: the mean of what is divided by is 0");
  Estimate ratio = paired_difference(theirs, ours);
  ratio.mean = 1 + ratio.mean / mean;
  ratio.low = 1 + ratio.low / mean;
  ratio.high = 1 + ratio.high / mean;
  ratio.sd /= mean;
  return ratio;
}

}  // namespace vantage
