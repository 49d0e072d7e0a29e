#include "vantage/map/integrate.hpp"

#include "vantage/map/integrator.hpp"

namespace vantage {

IntegrationReport integrate(VoxelMap& map, const RangeImage& image, std::span<const Vec3f> normals_in_sensor,
                            const View& view, QualityReference reference) {
  return Integrator().integrate(map, image, normals_in_sensor, view, reference);
}

}  // namespace vantage
