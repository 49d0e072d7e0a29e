#pragma once

#include "vantage/core/geometry.hpp"

namespace vantage::app {

/// Where the sensor is before the move that `evaluate` asks about.
struct CurrentPlace {
  Vec3 current{0, 0, 2};
};

template <class Field>
void describe(CurrentPlace& place, Field&& field) {
  field("current", place.current, "m", "where the sensor is now");
}

}  // namespace vantage::app
