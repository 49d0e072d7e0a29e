#pragma once

#include <optional>
#include <span>
#include <string>

#include "vantage/options/reconstruct_options.hpp"
#include "vantage/simulation/point_coverage.hpp"

namespace vantage {

/// Under which conditions methods are compared: those of a publication as far as they can be met. docs/methods.md says
/// where they differ from it.
struct Protocol {
  const char* name;
  const char* text;  // for the report
  const char* candidates;
  const char* camera;
  double voxel;                       // metres
  int enclosure, scene;               // voxels per side
  std::optional<double> size;         // largest side of every object, metres; else each has its own
  std::optional<PointMetric> metric;  // else coverage is that of voxels
  int max_views;

  void set(ReconstructOptions& options) const;
};

[[nodiscard]] std::span<const Protocol> known_protocols();
/// Throws InputError that lists the names.
[[nodiscard]] const Protocol& protocol_by_name(const std::string& name);
/// The names, separated by commas.
[[nodiscard]] std::string names_of_protocols();

}  // namespace vantage
