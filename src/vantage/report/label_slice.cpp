#include <fmt/format.h>

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/report/label_colors.hpp"
#include "vantage/report/svg_map.hpp"

namespace vantage {
namespace {

using svg::number;

/// What a label looks like in one row: stretches of equal labels as rectangles one voxel high, as a path in voxels.
struct LabelPath {
  std::string path;
  int voxels = 0;
};

std::array<LabelPath, all_labels.size()> label_paths(const LabelLayer& layer) {
  std::array<LabelPath, all_labels.size()> paths;
  const auto at = [&](int x, int y) {
    return layer
        .labels[static_cast<std::size_t>(y) * static_cast<std::size_t>(layer.columns) + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < layer.rows; ++y)
    for (int x = 0; x < layer.columns;) {
      const Label label = at(x, y);
      int end = x + 1;
      while (end < layer.columns && at(end, y) == label) ++end;
      LabelPath& stretch = paths[static_cast<std::size_t>(label)];
      stretch.path += fmt::format("M{} {}h{}v1H{}z", x, layer.rows - 1 - y, end - x, x);
      stretch.voxels += end - x;
      x = end;
    }
  return paths;
}

}  // namespace

LabelLayer label_layer(const VoxelMap& map, int z) {
  const IndexBox& box = map.enclosure();
  require(z >= box.min.z() && z <= box.max.z(), "slice z = ", z, ": must lie in the enclosure, ", box.min.z(), " to ",
          box.max.z());
  LabelLayer layer{z, box.size().x(), box.size().y(), {}, {}};
  layer.box = map.grid().box({{box.min.x(), box.min.y(), z}, {box.max.x(), box.max.y(), z}});
  for (int y = box.min.y(); y <= box.max.y(); ++y)
    for (int x = box.min.x(); x <= box.max.x(); ++x) layer.labels.push_back(map.label({x, y, z}));
  return layer;
}

int middle_layer(const VoxelMap& map) {
  double sum = 0;
  const std::vector<Index3> occupied = map.occupied_voxels();
  for (const Index3& voxel : occupied) sum += voxel.z();
  if (occupied.empty()) return (map.enclosure().min.z() + map.enclosure().max.z()) / 2;
  return static_cast<int>(std::lround(sum / static_cast<double>(occupied.size())));
}

std::string svg_plot(const LabelSlice& slice) {
  const LabelLayer& layer = slice.layer;
  require(layer.columns > 0 && layer.rows > 0 &&
              layer.labels.size() == static_cast<std::size_t>(layer.columns) * static_cast<std::size_t>(layer.rows),
          "slice of ", layer.columns, "x", layer.rows, " voxels holds ", layer.labels.size(), " labels");
  const auto scale_of = [](double low, double high) {
    svg::Scale scale = svg::scale_for({low, high}, {}, 4);
    scale.low = low;
    scale.high = high;
    std::erase_if(scale.ticks, [&](double tick) { return tick < low - 1e-9 || tick > high + 1e-9; });
    return scale;
  };
  svg::PlotArea area;
  area.x = scale_of(layer.box.min().x(), layer.box.max().x());
  area.y = scale_of(layer.box.min().y(), layer.box.max().y());
  area.left = 50;
  area.top = 30;
  constexpr double legend_height = 3 * svg::legend_row_height;
  const double pixels = std::min((slice.width - area.left - 10) / layer.columns,
                                 (slice.height - area.top - 44 - legend_height) / layer.rows);
  area.width = pixels * layer.columns;
  area.height = pixels * layer.rows;

  std::string drawing = svg::text(area.left, 16, slice.title, svg::Anchor::start, "name");
  drawing += area.axes({.label = "x [m]"}, {.label = "y [m]"});
  const auto paths = label_paths(layer);
  std::string cells;
  std::vector<svg::LegendEntry> legend;
  for (const Label label : {Label::unmarked, Label::empty, Label::occluded, Label::occplane, Label::occupied}) {
    const LabelPath& path = paths[static_cast<std::size_t>(label)];
    const std::string fill = css(label_color(label));
    if (path.voxels > 0) cells += fmt::format("<path fill=\"{}\" d=\"{}\"/>\n", fill, path.path);
    legend.push_back(
        {fmt::format("{} {}", name(label), path.voxels),
         fmt::format("<rect class=\"swatch\" x=\"-7\" y=\"-7\" width=\"14\" height=\"12\" fill=\"{}\"/>", fill)});
  }
  drawing += fmt::format("<g shape-rendering=\"crispEdges\" transform=\"translate({} {}) scale({:.5f})\">\n{}</g>\n",
                         number(area.left), number(area.top), pixels, cells);
  drawing += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", number(area.left),
                         number(area.top), number(area.width), number(area.height));
  drawing += svg::legend(area.left - 4, area.bottom() + 56, slice.width - area.left, legend);
  return svg::picture(slice.width, slice.height, slice.title, drawing);
}

}  // namespace vantage
