#include "vantage/model/registrar.hpp"

namespace vantage {
namespace {

PointCloud points_in(const Box3& region, const PointCloud& scan_in_sensor, const View& view) {
  PointCloud inside;
  for (std::size_t i = 0; i < scan_in_sensor.size(); ++i) {
    if (region.contains(view.world_from_sensor * scan_in_sensor.points[i])) {
      inside.add(scan_in_sensor.points[i], scan_in_sensor.normals[i]);
    }
  }
  return inside;
}

}  // namespace

Located IcpRegistrar::locate(const ModelSurface& model, const Scan& scan, const PointCloud& points,
                             const View& believed) {
  if (model.cloud().size() == 0) return {believed, true, 1, 0, "first", "the first scan defines the frame"};
  const Pose& start = believed.world_from_sensor;
  const auto* image = std::get_if<ImageScan>(&scan);
  const auto found = [&] {
    if (region_) return register_scan(model, points_in(*region_, points, believed), start, options_);
    // A range image also tells where nothing is.
    if (image != nullptr) return register_scan(model, points, image->image, start, options_);
    return register_scan(model, points, start, options_);
  }();
  return {View{found.world_from_sensor},    found.succeeded(), found.overlap, found.residual,
          std::string(name(found.verdict)), found.explanation};
}

}  // namespace vantage
