#include "vantage/reconstruction/registrar.hpp"

namespace vantage {

Located IcpRegistrar::locate(const ModelSurface& model, const PointCloud& scan_in_sensor, const View& believed) {
  if (model.cloud().size() == 0) return {believed, true, 1, 0, "first", "the first scan defines the frame"};
  const Registration found = register_scan(model, scan_in_sensor, believed.world_from_sensor, options_);
  return {View{found.world_from_sensor},    found.succeeded(), found.overlap, found.residual,
          std::string(name(found.verdict)), found.explanation};
}

}  // namespace vantage
