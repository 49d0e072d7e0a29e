#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vantage/doctor/consistency.hpp"
#include "vantage/doctor/finding.hpp"

namespace vantage {

/// How the frames are best explained.
struct Explained {
  Reading reading;
  Consistency given, consistency;  // as given; in this reading
  std::vector<Finding> findings;   // the mistakes that it takes to be made

  /// Whether the frames contradict each other, or see nothing in common, also in this reading.
  [[nodiscard]] bool is_wrong() const;
};

/// The mistakes that make the frames fit, if they do not fit as given: the best one, then the best on top of it. A
/// mistake is believed only where the frames fit once it is fixed. `depth_scale`: metres per unit that depths were read
/// with.
[[nodiscard]] Explained explain(const Evidence& evidence, double depth_scale,
                                const std::function<void(const std::string&)>& progress);

}  // namespace vantage
