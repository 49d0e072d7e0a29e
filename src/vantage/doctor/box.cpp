#include "vantage/doctor/box.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/order_statistics.hpp"

namespace vantage {
namespace {

using BoxNumbers = Eigen::Matrix<double, 6, 1>;

std::vector<Vec3> world_points(const Evidence& evidence, const Reading& reading) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < evidence.frames.size(); ++i) {
    for (const Vec3& point : points_of(evidence.frames[i], reading).points) {
      points.push_back(reading.world_from_sensor[i] * point);
    }
  }
  return points;
}

std::size_t points_within(const Box3& box, const std::vector<Vec3>& points) {
  return static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(), [&](const Vec3& p) { return box.contains(p); }));
}

Box3 around_center(const BoxNumbers& numbers) {
  return {numbers.head<3>() - 0.5 * numbers.tail<3>(), numbers.head<3>() + 0.5 * numbers.tail<3>()};
}

/// Where most of the points are.
BoxNumbers middle_of(const std::vector<Vec3>& points) {
  BoxNumbers numbers;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vec3& point : points) values.push_back(point[axis]);
    const double low = lower_quantile(values, 0.1), high = lower_quantile(values, 0.9);
    numbers[axis] = 0.5 * (low + high);
    numbers[axis + 3] = high - low;
  }
  // What is seen as a plane has no extent across it, but a box must have one.
  constexpr double thinnest = 0.05, least = 0.001;  // of the longest side; metres
  for (int axis = 3; axis < 6; ++axis)
    numbers[axis] = std::max({numbers[axis], thinnest * numbers.tail<3>().maxCoeff(), least});
  return numbers;
}

std::string text_of(const BoxNumbers& numbers) {
  std::string text;
  for (const double number : numbers) text += concat(text.empty() ? "" : ",", std::round(1e4 * number) / 1e4 + 0.0);
  return text;
}

}  // namespace

std::vector<Finding> check_box(const Evidence& evidence, const Reading& reading, const BoxNumbers& box) {
  const std::vector<Vec3> points = world_points(evidence, reading);
  if (points.empty() || points_within(around_center(box), points) > 0) return {};
  Finding finding{"box", concat("no frame has a point in the box ", text_of(box)), {}, {}};
  const BoxNumbers where = middle_of(points);
  finding.evidence = concat("eight tenths of the points lie, per axis, in ", text_of(where));
  const BoxNumbers millimetres = box / 1000;
  if (const Box3 corners(box.head<3>(), box.tail<3>()); !corners.isEmpty() && points_within(corners, points) > 0) {
    BoxNumbers fixed;
    fixed << corners.center(), corners.sizes();
    finding.fix = concat("the numbers look like two corners; give center and sizes: --box=", text_of(fixed));
  } else if (points_within(around_center(millimetres), points) > 0) {
    finding.fix = concat("the numbers look like millimetres; give metres: --box=", text_of(millimetres));
  } else {
    finding.fix = concat("give the box in the frame that the poses are in, for example --box=", text_of(where));
  }
  return {finding};
}

}  // namespace vantage
