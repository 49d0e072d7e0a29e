#pragma once

#include <cmath>

#include "vantage/map/label.hpp"

namespace vantage {

/// Probability that a voxel is occupied, by its label: the field's utilities are made for maps of probabilities.
struct OccupancyProbabilities {
  double unknown = 0.5;  // unmarked, occluded, occplane
  double empty = 0.12;
  double occupied = 0.97;

  /// Throws InputError where one is not in (0, 1).
  void validate() const;
  [[nodiscard]] double of(Label label) const {
    return label == Label::empty ? empty : label == Label::occupied ? occupied : unknown;
  }
};

/// H(p) = -p ln p - (1 - p) ln(1 - p), nats.
[[nodiscard]] inline double entropy(double p) { return -p * std::log(p) - (1 - p) * std::log(1 - p); }

[[nodiscard]] inline bool is_unknown(Label label) { return label != Label::empty && label != Label::occupied; }

}  // namespace vantage
