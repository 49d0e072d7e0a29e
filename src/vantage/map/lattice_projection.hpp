#pragma once

#include <array>
#include <vector>

#include "vantage/map/grid.hpp"
#include "vantage/sensor/range_camera.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// Pixels left .. right by top .. bottom, inclusive.
struct PixelRect {
  int left = 0, right = -1;
  int top = 0, bottom = -1;

  [[nodiscard]] bool is_empty() const { return left > right || top > bottom; }
};

/// Where the pixels of a view see the corners of a block of voxels. A point has the homogeneous pixel coordinates
/// (u, v, w): the ray of pixel (column, row) that passes it has column = u/w and row = v/w, and w is its depth. These
/// are linear in space, so that a corner of the lattice is a sum of three terms, one per axis, from a table.
class LatticeProjection {
 public:
  struct Homogeneous {
    double u, v, w;
    friend Homogeneous operator+(const Homogeneous& a, const Homogeneous& b) {
      return {a.u + b.u, a.v + b.v, a.w + b.w};
    }
  };

  /// What a view may see of a box.
  struct Footprint {
    enum class Kind {
      none,     // no ray meets the box
      bounded,  // only rays of `pixels` can meet it, and it lies in front of the camera
      anywhere  // it reaches behind the camera: any ray of `pixels`, the whole image, may meet it
    };
    Kind kind = Kind::none;
    PixelRect pixels;          // within the image
    bool is_in_image = false;  // the border of the image does not cut it
    double min_depth = 0, max_depth = 0;
    double margin = 0;  // by which `pixels` are wider than the projected corners, for rounding
  };

  /// Up to this depth the ray nearest to a voxel's centre, if within the image, passes the voxel.
  [[nodiscard]] static double dense_depth(const Grid& grid, const RangeCamera& camera);

  /// Tables for the voxels of `box`.
  void prepare(const Grid& grid, const IndexBox& box, const RangeCamera& camera, const View& view);

  /// Corner of the lattice, local to the box: 0 .. size on each axis.
  [[nodiscard]] Homogeneous corner(int x, int y, int z) const { return at(0, x) + (at(1, y) + at(2, z)); }
  /// The pixels of the image between these coordinates, widened by `margin`.
  [[nodiscard]] PixelRect pixels_within(double left, double right, double top, double bottom, double margin) const;
  /// The block of voxels from local index `low` up to but without `high`.
  [[nodiscard]] Footprint footprint(const Index3& low, const Index3& high) const;
  /// True where the ray nearest to the centre of any voxel of the block lies in the image and passes the voxel, and the
  /// near limit cuts none of them.
  [[nodiscard]] bool is_dense(const Footprint& block) const {
    return block.is_in_image && block.min_depth > near_ && block.max_depth < dense_depth_;
  }

 private:
  [[nodiscard]] const Homogeneous& at(int axis, int k) const {
    return tables_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(k)];
  }

  std::array<std::vector<Homogeneous>, 3> tables_;
  Resolution resolution_;
  double near_ = 0;
  double slack_ = 0;            // metres by which rounding may displace a point, generously
  double slack_in_pixels_ = 0;  // the same as a displacement of u, v and w
  double dense_depth_ = 0;
};

}  // namespace vantage
