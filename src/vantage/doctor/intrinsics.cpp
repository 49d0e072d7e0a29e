#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/doctor/hypothesis.hpp"

namespace vantage {

namespace {

std::vector<Hypothesis> other_resolutions(const Reading& base, const RangeCamera& camera) {
  // The intrinsics in units of the image, where they would be about (., 0.5): f and c over columns or rows.
  const double columns = camera.resolution.columns, rows = camera.resolution.rows;
  const double center_x = -camera.left / (camera.right - camera.left);
  std::vector<Hypothesis> hypotheses;
  for (const double factor : {0.25, 1.0 / 3, 0.5, 2.0 / 3, 0.75, 4.0 / 3, 1.5, 2.0, 3.0, 4.0}) {
    // True intrinsics are these times `factor`. A camera that then looks past its own image is none.
    if (std::abs(center_x * factor - 0.5) > 0.2) continue;
    Hypothesis each{"intrinsics", {}, {}, base};
    // x = (u - c) / f becomes (u - k c) / (k f) = x / k + (1 - k) / k * c / f, and c / f is minus the left border.
    each.reading.tangent_scale /= factor;
    each.reading.tangent_shift = base.tangent_shift - (1 - factor) / factor * Eigen::Vector2d(camera.left, camera.top);
    each.wrong = concat("the intrinsics are for images of about ", std::lround(columns / factor), "x",
                        std::lround(rows / factor), ", the frames have ", columns, "x", rows);
    each.fix = concat("multiply fx, fy, cx and cy by ", factor);
    hypotheses.push_back(std::move(each));
  }
  return hypotheses;
}

/// cx and cy the other way round: x = (u - cx) / fx becomes (u - cy) / fx.
std::vector<Hypothesis> swapped_center(const Reading& base, const RangeCamera& camera) {
  const double fx = camera.resolution.columns / (camera.right - camera.left);
  const double fy = camera.resolution.rows / (camera.bottom - camera.top);
  const double cx = -camera.left * fx - 0.5, cy = -camera.top * fy - 0.5;
  constexpr double same = 0.5;  // pixels
  const bool is_inside = cy < camera.resolution.columns && cx < camera.resolution.rows;
  if (std::abs(cx - cy) < same || !is_inside) return {};
  Hypothesis swapped{"intrinsics",
                     concat("cx and cy are swapped: cx = ", cx, ", cy = ", cy, " for images of ",
                            camera.resolution.columns, "x", camera.resolution.rows),
                     "write cx (the column) and cy (the row) the other way round", base};
  swapped.reading.tangent_shift += Eigen::Vector2d((cx - cy) / fx, (cy - cx) / fy);
  return {swapped};
}

}  // namespace

std::vector<Hypothesis> other_intrinsics(const Reading& base, const Evidence& evidence) {
  if (!evidence.camera) return {};
  std::vector<Hypothesis> all = swapped_center(base, *evidence.camera);
  for (Hypothesis& each : other_resolutions(base, *evidence.camera)) all.push_back(std::move(each));
  return all;
}

}  // namespace vantage
