#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "vantage/registration/scan_surface.hpp"

namespace vantage {

/// What a surface looks like around one of its places, whatever the pose: a fast point feature histogram (Rusu, Blodow
/// and Beetz, ICRA 2009) of three times eleven bins, as square roots, so that the product of two is their likeness,
/// 0..1. Three zeros fill it up to whole vector registers.
using SurfaceDescriptor = Eigen::Matrix<float, 36, 1>;

/// Places of a surface by which it is recognised.
struct SurfaceFeatures {
  double cell = 0;  // about the distance between places, metres
  std::vector<SurfaceSample> places;
  std::vector<SurfaceDescriptor> descriptors;  // of the places
};

/// The distance between places at which a scan has about as many as are compared with those of others, metres.
[[nodiscard]] double feature_cell(const ScanSurface& scan);

/// Features of a surface, a place per cell of a lattice and per side of a wall; of many, those that are least flat.
/// Surfaces are compared that have the same cell. Throws InputError unless the cell is positive.
[[nodiscard]] SurfaceFeatures surface_features(std::span<const SurfaceSample> samples, double cell);

}  // namespace vantage
