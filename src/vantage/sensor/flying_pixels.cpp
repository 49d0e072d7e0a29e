#include "vantage/sensor/flying_pixels.hpp"

#include <array>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr int rows_per_task = 16;
constexpr int reach = 2;  // pixels to either side that a comparison looks at

/// z with P(|standard normal| > z) = share, by bisection of the complementary error function.
double two_sided_quantile(double share) {
  double low = 0;
  double high = 40;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erfc(middle / std::numbers::sqrt2) > share ? low : high) = middle;
  }
  return high;
}

/// A line through a pixel: to the right, down, and both diagonals.
struct Line {
  int columns, rows;
};
constexpr std::array<Line, 4> lines{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};

class FlyingPixelTest {
 public:
  FlyingPixelTest(const RangeImage& image, const SensorModel& sensor, const FlyingPixelOptions& options)
      : depth_(image.depth.data()),
        resolution_(image.camera.resolution),
        sensor_(sensor),
        quantile_(two_sided_quantile(options.false_positive_rate)),
        max_step_(options.max_step_in_footprints) {
    const RayGrid rays = image.camera.rays();
    const double x = 2 * rays.x_half / resolution_.columns;
    const double y = 2 * rays.y_half / resolution_.rows;
    pitch_ = {x, y, std::hypot(x, y), std::hypot(x, y)};
  }

  [[nodiscard]] bool is_flying(int column, int row) const {
    const double depth = at(column, row);
    if (depth == 0) return false;
    const Pixel pixel{column, row, depth, quantile_ * sensor_.sigma(depth)};
    std::size_t explaining = 0;
    int explained = 0;
    int judged = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const Verdict verdict = along(pixel, i);
      if (verdict == Verdict::not_judged) continue;
      ++judged;
      if (verdict != Verdict::on_surface) continue;
      explaining = i;
      if (++explained == 2) return false;
    }
    if (explained == 0) return judged > 0;
    return judged > 1 && is_beside_nearer(pixel, lines[explaining]);
  }

 private:
  struct Pixel {
    int column, row;
    double depth;
    double noise;  // the quantile times the standard deviation of one depth, seen frontally
  };
  enum class Verdict { not_judged, jumps, on_surface };

  /// 0 where there is no hit.
  [[nodiscard]] double at(int column, int row) const {
    if (column < 0 || column >= resolution_.columns || row < 0 || row >= resolution_.rows) return 0;
    const float depth = depth_[static_cast<std::size_t>(row) * static_cast<std::size_t>(resolution_.columns) +
                               static_cast<std::size_t>(column)];
    return RangeImage::is_hit(depth) ? static_cast<double>(depth) : 0;
  }

  /// Do three depths in a row lie on one surface? `noise` is that of Pixel.
  [[nodiscard]] bool on_one_surface(double first, double second, double third, double footprint, double noise,
                                    bool end) const {
    const double step = second - first;
    const double next = third - second;
    const double smaller = std::min(std::abs(step), std::abs(next));
    if (sensor_.incidence > 0) {  // noisier on a slope
      const double tangent = smaller / footprint;
      noise += quantile_ * sensor_.incidence * std::min(tangent * tangent, max_step_ * max_step_);
    }
    if (std::max(std::abs(step), std::abs(next)) > max_step_ * footprint + std::numbers::sqrt2 * noise) return false;
    const double allowed = std::max(footprint, end && step * next > 0 ? smaller : 0.0);
    return std::abs(next - step) <= allowed + std::sqrt(6.0) * noise;
  }

  [[nodiscard]] Verdict along(const Pixel& pixel, std::size_t line) const {
    const auto [columns, rows] = lines[line];
    const double footprint = pitch_[line] * pixel.depth;
    const double before = at(pixel.column - columns, pixel.row - rows);
    const double after = at(pixel.column + columns, pixel.row + rows);
    bool judged = false;
    const auto test = [&](double first, double second, double third, bool end) {
      if (first == 0 || second == 0 || third == 0) return false;
      judged = true;
      return on_one_surface(first, second, third, footprint, pixel.noise, end);
    };
    if (test(before, pixel.depth, after, false)) return Verdict::on_surface;
    const double far_after = at(pixel.column + reach * columns, pixel.row + reach * rows);
    if (test(pixel.depth, after, far_after, true)) return Verdict::on_surface;
    const double far_before = at(pixel.column - reach * columns, pixel.row - reach * rows);
    if (test(far_before, before, pixel.depth, true)) return Verdict::on_surface;
    return judged ? Verdict::jumps : Verdict::not_judged;
  }

  /// Is a hit beside the line through the pixel nearer by more than its distance in the image and noise?
  [[nodiscard]] bool is_beside_nearer(const Pixel& pixel, const Line& line) const {
    const double noise = std::numbers::sqrt2 * pixel.noise;
    for (int rows = -reach; rows <= reach; ++rows) {
      for (int columns = -reach; columns <= reach; ++columns) {
        if (columns * line.rows == rows * line.columns) continue;  // on the line
        const double other = at(pixel.column + columns, pixel.row + rows);
        if (other == 0) continue;
        const double footprint = pixel.depth * std::hypot(columns * pitch_[0], rows * pitch_[1]);
        if (pixel.depth - other > footprint + noise) return true;
      }
    }
    return false;
  }

  const float* depth_;
  Resolution resolution_;
  const SensorModel& sensor_;
  double quantile_;
  double max_step_;
  std::array<double, 4> pitch_{};  // between neighbours of each line, as a tangent
};

}  // namespace

void FlyingPixelOptions::validate() const {
  require(false_positive_rate > 0 && false_positive_rate < 1, "false_positive_rate = ", false_positive_rate,
          ": must be between 0 and 1");
  require(max_step_in_footprints > 0 && std::isfinite(max_step_in_footprints),
          "max_step_in_footprints = ", max_step_in_footprints, ": must be positive");
}

std::vector<std::uint8_t> flying_pixels(const RangeImage& image, const SensorModel& sensor,
                                        const FlyingPixelOptions& options) {
  image.validate();
  sensor.validate();
  options.validate();
  const auto [columns, rows] = image.camera.resolution;
  std::vector<std::uint8_t> flags(image.depth.size(), 0);
  const FlyingPixelTest test(image, sensor, options);
  parallel_for(static_cast<std::size_t>((rows + rows_per_task - 1) / rows_per_task), [&](std::size_t task) {
    const int first = static_cast<int>(task) * rows_per_task;
    for (int row = first; row < std::min(first + rows_per_task, rows); ++row) {
      std::uint8_t* const flag = flags.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
      for (int column = 0; column < columns; ++column) flag[column] = test.is_flying(column, row) ? 1 : 0;
    }
  });
  return flags;
}

CleanImage without_flying_pixels(RangeImage image, const SensorModel& sensor, const FlyingPixelOptions& options) {
  const std::vector<std::uint8_t> flags = flying_pixels(image, sensor, options);
  CleanImage clean{std::move(image), 0, 0};
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (RangeImage::is_hit(clean.image.depth[i])) ++clean.hits;
    if (flags[i] == 0) continue;
    ++clean.flying;
    clean.image.depth[i] = RangeImage::unknown;
  }
  return clean;
}

}  // namespace vantage
