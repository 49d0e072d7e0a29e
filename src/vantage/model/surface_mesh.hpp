#pragma once

#include "vantage/core/measured_mesh.hpp"
#include "vantage/model/surface_net.hpp"

namespace vantage {

/// A part of the surface that fewer frames saw than this is no surface.
constexpr int least_frames_of_a_part = 3;

/// What was seen of the net, without the parts that fewer than `least_frames` frames saw, and with as many vertices as
/// fans of triangles where its border touches itself.
[[nodiscard]] MeasuredMesh open_mesh(const SurfaceNet& net, int least_frames);
/// The whole net, what nobody saw marked as caps, without the parts that fewer than `least_frames` frames saw and
/// without cavities, which nobody can have seen. The net of a closed field stays closed.
[[nodiscard]] MeasuredMesh closed_mesh(const SurfaceNet& net, int least_frames);

}  // namespace vantage
