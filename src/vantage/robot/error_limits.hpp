#pragma once

#include <numbers>

namespace vantage {

/// Metres: mean and standard deviations of a robot's position. The world of a scene ends there: an error beyond says
/// nothing about a robot, and rays from there nothing about a map.
inline constexpr double largest_position_error = 1e6;
/// Radians: a robot that errs by more than half a turn points anywhere.
inline constexpr double largest_turn_error = std::numbers::pi;

}  // namespace vantage
