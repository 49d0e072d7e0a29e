#include "vantage/visibility/pixel_frame.hpp"

#include <Eigen/LU>

namespace vantage {

PixelFrame::PixelFrame(const Grid& map_grid, const IndexBox& map_enclosure, const RangeCamera& camera, const View& view,
                       Resolution ray_resolution)
    : grid(map_grid),
      enclosure(map_enclosure),
      resolution(ray_resolution),
      rays(camera.rays(ray_resolution)),
      rotation(view.world_from_sensor.linear()),
      origin(view.position()),
      origin_cell(map_grid.index_of(view.position())),
      near(camera.min_depth),
      far(camera.max_depth) {
  const double column_pitch = 2 * rays.x_half / resolution.columns;
  const double row_pitch = 2 * rays.y_half / resolution.rows;
  directions.col(0) = rotation.col(0) * column_pitch;
  directions.col(1) = rotation.col(1) * row_pitch;
  directions.col(2) = ray_direction(rotation, rays.x(0), rays.y(0));
  pixel_from_offset = directions.inverse();
  half_extent = 0.5 * pixel_from_offset.cwiseAbs().rowwise().sum();
  longest = (directions.cwiseAbs() * Vec3(resolution.columns, resolution.rows, 1)).maxCoeff();
}

bool PixelFrame::ray_passes(int column, int row, const Index3& voxel) const {
  const LatticeRay ray(origin, origin_cell, ray_direction(rotation, rays.x(column), rays.y(row)));
  return passes_voxel(grid, ray, enclosure.min + voxel, near, far);
}

}  // namespace vantage
