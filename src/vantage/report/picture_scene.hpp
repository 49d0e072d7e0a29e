#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "vantage/core/point_cloud.hpp"
#include "vantage/core/triangle_mesh.hpp"
#include "vantage/map/voxel_map.hpp"
#include "vantage/report/color.hpp"
#include "vantage/sensor/range_camera.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// What a picture shows, in world coordinates (metres). Solids are lit and shade each other; markers (cameras) are lit
/// but cast no shade; strokes, dots and badges keep their colour and their width in pixels. Nearer hides farther,
/// except for badges, which are always in front.
struct PictureScene {
  enum class Finish { solid, voxel, marker };  // a voxel shows the edges of its faces
  struct Facet {
    std::array<Vec3f, 3> corner, normal;  // unit normals, interpolated over the facet; both sides are shown
    Color color;
    Finish finish = Finish::solid;
  };
  struct Disc {
    Vec3f center, normal;  // (0,0,0): turned to the camera
    float radius = 0;      // metres
    Color color;
  };
  struct Stroke {
    Vec3f from, to;
    float width = 1;  // pixels
    Color color;
  };
  struct Dot {
    Vec3f center;
    float radius = 2;  // pixels
    Color color;
  };
  struct Badge {
    Vec3 place;
    int number = 0;
    Color color;
  };

  std::vector<Facet> facets;
  std::vector<Disc> discs;
  std::vector<Stroke> strokes;
  std::vector<Dot> dots;
  std::vector<Badge> badges;
  Grid lattice;  // where the edges of voxels are drawn; set by add_voxels

  /// The box around solids (facets that are no markers, and discs); empty where there are none.
  [[nodiscard]] Box3 solid_box() const;
  /// Every corner, centre and end of all primitives.
  [[nodiscard]] std::vector<Vec3> points() const;
  /// The box around them.
  [[nodiscard]] Box3 box() const;
};

/// A surface with normals smoothed over edges flatter than 45 degrees.
void add_mesh(PictureScene& scene, const TriangleMesh& mesh, const Color& color);

/// A cloud as discs of `radius` metres across their normals.
void add_cloud(PictureScene& scene, const PointCloud& cloud, double radius, const Color& color);

/// The colour of a voxel (scene index), or nothing where it is not to be drawn.
using VoxelPaint = std::function<std::optional<Color>(const Index3&)>;
/// Occupied voxels plain, occplane voxels in the label's colour; the other labels are not drawn.
[[nodiscard]] VoxelPaint paint_labels(const VoxelMap& map);
/// Occupied voxels by their quality on the sequential scale, from 0 to 1.
[[nodiscard]] VoxelPaint paint_quality(const VoxelMap& map);
/// Occupied voxels by the direction of their normals: x, y and z as red, green and blue; grey without a normal.
[[nodiscard]] VoxelPaint paint_normals(const VoxelMap& map);
/// The visible faces of all voxels of the enclosure that `paint` colours. `map` gives the place only.
void add_voxels(PictureScene& scene, const VoxelMap& map, const VoxelPaint& paint);

/// A line through all points.
void add_path(PictureScene& scene, std::span<const Vec3> points, double width, const Color& color);
/// A camera as a pyramid with the sensor's shape, `length` metres from the eye to the image.
void add_camera(PictureScene& scene, const View& view, const RangeCamera& camera, double length, const Color& color);
/// The twelve edges of a box.
void add_box(PictureScene& scene, const Box3& box, double width, const Color& color);

/// The way on a sphere around `center` from one point to another, both included: the radius changes evenly.
[[nodiscard]] std::vector<Vec3> arc(const Vec3& from, const Vec3& to, const Vec3& center);

}  // namespace vantage
