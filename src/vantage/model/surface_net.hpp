#pragma once

#include "vantage/core/triangle_mesh.hpp"
#include "vantage/model/surface_field.hpp"

namespace vantage {

/// What is known at a vertex of a net.
struct NetVertex {
  Vec3f position = Vec3f::Zero();               // world, metres
  float sigma = 0;                              // of the position along the normal, metres; where seen
  bool is_seen = false;                         // all corners of its cell were measured, and of the same surface
  std::uint8_t frames = 0;                      // most frames that saw a surface at a corner, up to 3
  std::array<std::uint16_t, 2> first_frames{};  // two of these, where there are as many
};

/// A surface cut from a field.
struct SurfaceNet {
  std::vector<NetVertex> vertices;
  std::vector<Index3> triangles;  // counter-clockwise seen from outside
};

/// The zero set of the field in the cells that lie in the box and whose corners all have a surface nearby: one vertex
/// per sheet and cell, at the point that lies best on the planes where the sheet crosses the cell's edges, so that
/// edges stay sharp (dual contouring, Ju et al. 2002; sheets as in Nielson's dual marching cubes, 2004). Every edge of
/// the net has two triangles, or one where the field ends; every vertex one fan. Same bits for any number of threads.
[[nodiscard]] SurfaceNet surface_net(const SurfaceField& field, const Box3& box);

}  // namespace vantage
