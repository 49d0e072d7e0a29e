#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/simulation/object_shapes.hpp"
#include "vantage/simulation/surface_builder.hpp"

namespace vantage {
namespace {

/// 0 below `from`, 1 above `to`, smooth between.
double smooth_step(double from, double to, double value) {
  const double x = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

}  // namespace

// One solid of revolution, belly, neck, the dip around the stem and the stem; then the neck leans and the stem bends.
TriangleMesh pear_shape() {
  const std::array<OutlinePoint, 24> corners{
      {{0, 0.03},     {0.05, 0.022},  {0.13, 0.004}, {0.24, 0.022},  {0.335, 0.09},  {0.392, 0.19},
       {0.40, 0.29},  {0.372, 0.39},  {0.32, 0.48},  {0.265, 0.57},  {0.222, 0.66},  {0.192, 0.75},
       {0.164, 0.83}, {0.122, 0.885}, {0.07, 0.905}, {0.036, 0.895}, {0.026, 0.905}, {0.022, 0.93},
       {0.02, 0.96},  {0.021, 1.0},   {0.027, 1.03}, {0.028, 1.042}, {0.018, 1.047}, {0, 1.048}}};
  TriangleMesh pear = solid_of_revolution(smooth_curve(corners, 5), 72);
  for (Vec3& vertex : pear.vertices) {
    const double lean = 0.05 * smooth_step(0.35, 1.0, vertex.z());
    const double bend = 0.05 * std::pow(smooth_step(0.9, 1.15, vertex.z()), 2);
    vertex.x() += lean + bend;
  }
  return pear;
}

}  // namespace vantage
