#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/core/geometry.hpp"
#include "vantage/map/voxel_map.hpp"
#include "vantage/report/plot_area.hpp"

namespace vantage {

/// Values of a function of two coordinates on a regular grid, row 0 at the least y. NaN: no value there.
struct GridValues {
  int columns = 0, rows = 0;
  std::vector<double> values;                           // row by row
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;  // outer borders of the cells
  std::string x_label, y_label, value_label;
  /// Ends of the colour scale; the values' own where not given, so that two maps can share one.
  std::optional<double> value_low, value_high;

  /// Throws InputError where the sizes do not agree or a range is empty.
  void validate() const;
};

struct HeatMap {
  std::string title;
  GridValues grid;
  double width = 420, height = 340;
};

/// A surface over the plane seen from above at an angle, coloured by height.
struct SurfacePlot {
  std::string title;
  GridValues grid;
  double width = 420, height = 320;
};

/// Values of views around a center, on a map of the whole sphere with true areas (Mollweide): north is +z, the middle
/// is -y, +x to its right.
struct SphereMap {
  std::string title;
  std::vector<Vec3> directions;       // from the center, any length but 0
  std::vector<double> values;         // NaN: not evaluated (open circle)
  std::optional<std::size_t> chosen;  // gets a ring
  std::string value_label;
  double width = 520, height = 330;
};

/// The labels of one layer of the enclosure: small enough to keep for every scan.
struct LabelLayer {
  int z = 0;                  // scene index
  int columns = 0, rows = 0;  // along x and y
  std::vector<Label> labels;  // x fastest
  Box3 box;                   // of the layer, metres
};
[[nodiscard]] LabelLayer label_layer(const VoxelMap& map, int z);
/// The layer through the middle of all occupied voxels, or of the enclosure where there are none.
[[nodiscard]] int middle_layer(const VoxelMap& map);

/// A horizontal slice through the labels (the paper's figure 4).
struct LabelSlice {
  std::string title;
  LabelLayer layer;
  double width = 340, height = 400;
};

[[nodiscard]] std::string svg_plot(const HeatMap& map);
[[nodiscard]] std::string svg_plot(const SurfacePlot& plot);
[[nodiscard]] std::string svg_plot(const SphereMap& map);
/// With the legend and the number of voxels per label in the slice.
[[nodiscard]] std::string svg_plot(const LabelSlice& slice);

namespace svg {
/// Mollweide's projection of a direction: x in [-2, 2], y in [-1, 1].
struct MapPoint {
  double x = 0, y = 0;
};
[[nodiscard]] MapPoint mollweide(const Vec3& direction);
}  // namespace svg

}  // namespace vantage
