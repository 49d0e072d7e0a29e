#include "vantage/map/integrate.hpp"

namespace vantage {

IntegrationReport integrate(VoxelMap& map, const RangeImage& image, std::span<const Vec3f> normals_in_sensor,
                            const View& view, QualityReference reference) {
  return integrate_exactly(map, sight_lines(image, normals_in_sensor, view, reference));
}

}  // namespace vantage
