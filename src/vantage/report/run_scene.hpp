#pragma once

#include <optional>

#include "vantage/report/picture_scene.hpp"
#include "vantage/report/report_data.hpp"

namespace vantage {

/// The model as a solid: the mesh, or else the cloud, or else the occupied voxels. Empty where there is none of them.
[[nodiscard]] PictureScene model_scene(const ReportData& data);

/// The model among the views of the run: candidates as dots, the views taken as numbered cameras, the way between them.
[[nodiscard]] PictureScene views_scene(const ReportData& data);

/// Height along `up` of the lowest point of the solids; nothing where there are none.
[[nodiscard]] std::optional<double> floor_under(const PictureScene& scene, const Vec3& up);

/// A direction `turn` degrees around `up` from the front (-y, as far as it is horizontal) towards +x, `rise` degrees
/// above the horizon.
[[nodiscard]] Vec3 side_of(const Vec3& up, double turn, double rise);

}  // namespace vantage
