#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "vantage/core/error.hpp"
#include "vantage/sensor/range_camera.hpp"

namespace vantage::app {

/// What looking from so many views with so many rays each costs, as a sentence; empty where it is nothing to speak of.
/// Throws InputError where nobody would live to see the end.
[[nodiscard]] inline std::string cost_note(std::size_t views, const Resolution& rays) {
  constexpr double rays_per_second = 5e6;    // of one processor, about
  constexpr double rays_worth_a_word = 1e9;  // minutes
  constexpr double most_rays = 1e13;         // weeks
  const double all = static_cast<double>(views) * rays.columns * rays.rows;
  require(all <= most_rays, "candidates, camera: ", views, " views of ", rays.columns, "x", rays.rows, " rays are ",
          all, " rays for every look around; must be at most ", most_rays);
  if (all < rays_worth_a_word) return {};
  return fmt::format(
      "{} views of {}x{} rays are {:.2g} rays for every look around, up to {:.0f} minutes of a processor; fewer "
      "candidates or rays cost less",
      views, rays.columns, rays.rows, all, all / rays_per_second / 60);
}

}  // namespace vantage::app
