#pragma once

#include <cstddef>
#include <optional>

#include "vantage/core/measured_mesh.hpp"

namespace vantage {

/// How good a measured surface is. Areas in m^2, the volume in m^3, deviations in metres.
struct MeshQuality {
  std::size_t triangles = 0;
  double seen_area = 0;          // without caps
  double cap_area = 0;           // that nobody saw
  std::optional<double> volume;  // enclosed; of closed meshes
  /// Of the seen surface by area: half of it, and 95 %, has a smaller standard deviation than this.
  double median_sigma = 0, percentile_95_sigma = 0;
  std::optional<double> wanted_sigma;   // the accuracy that was asked for
  std::optional<double> accurate_area;  // of the seen surface that has it

  [[nodiscard]] double cap_share() const {
    const double area = seen_area + cap_area;
    return area > 0 ? cap_area / area : 0;
  }
};

[[nodiscard]] MeshQuality quality_of(const MeasuredMesh& mesh, const std::optional<double>& wanted_sigma = {});

}  // namespace vantage
