#include "vantage/map/grid.hpp"

#include "vantage/core/error.hpp"

namespace vantage {
namespace {
constexpr int max_side = 16384;  // keeps products of three sides and of indices in range
}

void Grid::validate() const {
  require(min.allFinite() && min.cwiseAbs().maxCoeff() < 1e6, "scene: the corner (", min.transpose(),
          ") m is not a reasonable place; are the units metres?");
  require(std::isfinite(length) && length > 0, "voxel length = ", length, " m: must be positive");
  require(length >= 1e-6 && length <= 1e3, "voxel length = ", length, " m: must be within 1e-6 and 1e3 m");
  require((size.array() > 0).all(), "scene size = ", size.transpose(), " voxels: must be positive on every axis");
  require((size.array() <= max_side).all(), "scene size = ", size.transpose(), " voxels: at most ", max_side,
          " per axis; use longer voxels");
}

void SceneOptions::validate() const {
  require(center.allFinite(), "scene center = ", center.transpose(), ": must be finite numbers");
  grid().validate();
  require((enclosure_size.array() > 0).all(), "enclosure size = ", enclosure_size.transpose(),
          " voxels: must be positive on every axis");
  require((enclosure_size.array() <= scene_size.array()).all(), "enclosure size = ", enclosure_size.transpose(),
          " voxels: must fit into the scene of ", scene_size.transpose(), " voxels");
}

Grid SceneOptions::grid() const {
  const Vec3 half = 0.5 * voxel_length * scene_size.cast<double>();
  return {center - half, voxel_length, scene_size};
}

IndexBox SceneOptions::enclosure() const {
  const Index3 min = (scene_size - enclosure_size) / 2;
  return {min, min + enclosure_size - Index3::Ones()};
}

}  // namespace vantage
