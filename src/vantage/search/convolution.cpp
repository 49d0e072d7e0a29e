#include "vantage/search/convolution.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr double support_sigmas = 4;         // of the kernel on candidate sets that are no grid
constexpr double support_on_grid = 6;        // of kernels that differ from cell to cell, per axis
constexpr double off_grid_tolerance = 1e-9;  // metres: candidates that count as the same place

/// Values on the n^3 cells of a view cube, x fastest; 0 where there is no candidate.
struct DenseGrid {
  int n;
  std::vector<double> values;

  [[nodiscard]] std::size_t at(int x, int y, int z) const {
    const auto side = static_cast<std::size_t>(n);
    return (static_cast<std::size_t>(z) * side + static_cast<std::size_t>(y)) * side + static_cast<std::size_t>(x);
  }
};

DenseGrid spread(std::span<const double> utilities, const CandidateGrid& grid) {
  const int n = grid.cells_per_side;
  DenseGrid dense{
      n, std::vector<double>(static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * static_cast<std::size_t>(n))};
  for (std::size_t i = 0; i < utilities.size(); ++i) {
    const Index3& cell = grid.cell_of_view[i];
    dense.values[dense.at(cell.x(), cell.y(), cell.z())] = utilities[i];
  }
  return dense;
}

std::vector<double> gather(const DenseGrid& dense, const CandidateGrid& grid) {
  std::vector<double> values;
  values.reserve(grid.cell_of_view.size());
  for (const Index3& cell : grid.cell_of_view) values.push_back(dense.values[dense.at(cell.x(), cell.y(), cell.z())]);
  return values;
}

/// f[m] of one axis for m = -(n-1) .. n-1.
std::vector<double> axis_kernel(int n, double spacing, double mean, double sigma, const ConvolutionOptions& options) {
  std::vector<double> kernel;
  for (int m = 1 - n; m < n; ++m) {
    const double offset = m * spacing - mean;
    double value = 0;
    if (sigma > 0) {
      const double z = offset / sigma;
      value = options.truncate_sigmas && std::abs(z) > *options.truncate_sigmas ? 0 : std::exp(-0.5 * z * z);
    } else {
      value = offset > -0.5 * spacing && offset <= 0.5 * spacing ? 1 : 0;
    }
    kernel.push_back(value);
  }
  return kernel;
}

/// Convolves along the slowest axis and makes it the fastest one: three times in a row, and all axes are done and in
/// their places again. Every sum runs over ascending cells, for several lines at a time, which are neighbours in
/// memory.
void convolve_slowest_axis(DenseGrid& grid, const std::vector<double>& kernel) {
  const auto n = static_cast<std::size_t>(grid.n);
  const std::size_t lines = n * n;
  constexpr std::size_t at_a_time = 8;
  std::vector<double> result(grid.values.size());
  const auto convolve_lines = [&](std::size_t line, auto count) {
    for (std::size_t v = 0; v < n; ++v) {
      const double* const weights = kernel.data() + n - 1 - v;
      std::array<double, count()> sums{};
      for (std::size_t u = 0; u < n; ++u) {
        const double* const values = grid.values.data() + u * lines + line;
        for (std::size_t i = 0; i < count(); ++i) sums[i] += weights[u] * values[i];
      }
      for (std::size_t i = 0; i < count(); ++i) result[(line + i) * n + v] = sums[i];
    }
  };
  std::size_t line = 0;
  for (; line + at_a_time <= lines; line += at_a_time) {
    convolve_lines(line, std::integral_constant<std::size_t, at_a_time>());
  }
  for (; line < lines; ++line) convolve_lines(line, std::integral_constant<std::size_t, 1>());
  grid.values = std::move(result);
}

std::vector<double> convolve_separably(std::span<const double> utilities, const CandidateGrid& grid,
                                       const PositioningError& error, const ConvolutionOptions& options) {
  DenseGrid dense = spread(utilities, grid);
  double total = 1;
  for (const int axis : {2, 1, 0}) {
    const std::vector<double> kernel = axis_kernel(grid.cells_per_side, grid.spacing[axis], error.mean[axis],
                                                   std::sqrt(error.covariance(axis, axis)), options);
    convolve_slowest_axis(dense, kernel);
    double sum = 0;
    for (const double value : kernel) sum += value;
    total *= sum;
  }
  std::vector<double> result = gather(dense, grid);
  if (options.normalise && total > 0) {
    for (double& value : result) value /= total;
  }
  return result;
}

/// What an error may cost whose axes do not err independently: cells of a kernel, a gigabyte.
constexpr double most_cells = 1 << 27;

std::vector<double> convolve_directly(std::span<const double> utilities, const CandidateGrid& grid,
                                      const PositioningError& error, const ConvolutionOptions& options) {
  const int n = grid.cells_per_side;
  const int width = 2 * n - 1;
  require(std::pow(width, 3) <= most_cells, "convolution: the covariance is not diagonal, so that a view cube of ", n,
          " cells per side needs a kernel of ", width, " x ", width, " x ", width,
          " cells; must be at most 256 per side, or use samples");
  const ErrorDensity density(error, 0.5 * grid.spacing);
  std::vector<double> kernel;
  kernel.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(width) * static_cast<std::size_t>(width));
  double total = 0;
  for (int z = 1 - n; z < n; ++z) {
    for (int y = 1 - n; y < n; ++y) {
      for (int x = 1 - n; x < n; ++x) {
        const Vec3 offset = Vec3(x, y, z).cwiseProduct(grid.spacing);
        const bool kept = !options.truncate_sigmas ||
                          density.squared_distance(offset) <= *options.truncate_sigmas * *options.truncate_sigmas;
        kernel.push_back(kept ? density(offset) : 0);
        total += kernel.back();
      }
    }
  }
  std::vector<double> result(utilities.size());
  parallel_for(utilities.size(), [&](std::size_t v) {
    double sum = 0;
    for (std::size_t u = 0; u < utilities.size(); ++u) {
      const Index3 m = grid.cell_of_view[u] - grid.cell_of_view[v] + Index3::Constant(n - 1);
      sum += kernel[static_cast<std::size_t>((m.z() * width + m.y()) * width + m.x())] * utilities[u];
    }
    result[v] = options.normalise && total > 0 ? sum / total : sum;
  });
  return result;
}

/// The mean over the neighbours of candidate v within the kernel's support.
double mean_of_neighbours(std::size_t v, std::span<const double> utilities, const Candidates& candidates,
                          const ErrorDensity& density) {
  double sum = 0;
  double weights = 0;
  for (std::size_t u = 0; u < utilities.size(); ++u) {
    const Vec3 offset = candidates.views[u].position() - candidates.views[v].position();
    const double distance = density.squared_distance(offset);
    if (distance > support_sigmas * support_sigmas) continue;
    const double weight = std::exp(-0.5 * distance);
    sum += weight * utilities[u];
    weights += weight;
  }
  // No candidate where the robot would end up: nothing but the view itself tells what to expect.
  return weights > 0 ? sum / weights : utilities[v];
}

std::vector<double> convolve_neighbours(std::span<const double> utilities, const Candidates& candidates,
                                        const PositioningError& error) {
  const ErrorDensity density(error, Vec3::Constant(off_grid_tolerance));
  std::vector<double> result(utilities.size());
  parallel_for(utilities.size(),
               [&](std::size_t v) { result[v] = mean_of_neighbours(v, utilities, candidates, density); });
  return result;
}

/// Eq. 20 around one cell, divided by the sum of the whole kernel, in which cells without a candidate count too.
double mean_around(const Index3& cell, const DenseGrid& dense, const CandidateGrid& grid, const PositioningError& error,
                   const ConvolutionOptions& options) {
  const ErrorDensity density(error, 0.5 * grid.spacing);
  const Vec3 reach = error.mean.cwiseAbs() + support_on_grid * error.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const Vec3 cells = (reach.array() / grid.spacing.array()).ceil().max(1);
  require((2 * cells.array() + 1).prod() <= most_cells, "convolution: an error that reaches ", reach.transpose(),
          " m covers ", (2 * cells.array() + 1).transpose(), " cells of the view cube; must be at most ", most_cells,
          " in all: use a coarser view cube, or samples");
  const Index3 width = cells.cast<int>();
  double sum = 0;
  double weights = 0;
  for (int z = -width.z(); z <= width.z(); ++z) {
    for (int y = -width.y(); y <= width.y(); ++y) {
      for (int x = -width.x(); x <= width.x(); ++x) {
        const Index3 m(x, y, z);
        const double distance = density.squared_distance(m.cast<double>().cwiseProduct(grid.spacing));
        if (options.truncate_sigmas && distance > *options.truncate_sigmas * *options.truncate_sigmas) continue;
        const double weight = std::exp(-0.5 * distance);
        weights += weight;
        const Index3 there = cell + m;
        if ((there.array() < 0).any() || (there.array() >= dense.n).any()) continue;
        sum += weight * dense.values[dense.at(there.x(), there.y(), there.z())];
      }
    }
  }
  return weights > 0 ? sum / weights : 0;
}

}  // namespace

void ConvolutionOptions::validate() const {
  require(!truncate_sigmas || *truncate_sigmas > 0, "convolution: truncation at ", truncate_sigmas.value_or(0),
          " sigma: must be positive");
}

ErrorDensity::ErrorDensity(const PositioningError& error, const Vec3& resolution) : mean_(error.mean) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(error.covariance);
  axes_ = solver.eigenvectors();
  const double scale = std::max(solver.eigenvalues().cwiseAbs().maxCoeff(), 1e-30);
  for (int i = 0; i < 3; ++i) {
    const double variance = solver.eigenvalues()[i];
    inverse_variance_[i] = variance > 1e-12 * scale ? 1 / variance : 0;
    tolerance_[i] = axes_.col(i).cwiseAbs().dot(resolution);
  }
}

double ErrorDensity::squared_distance(const Vec3& offset) const {
  const Vec3 along_axes = axes_.transpose() * (offset - mean_);
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    if (inverse_variance_[i] > 0) {
      sum += along_axes[i] * along_axes[i] * inverse_variance_[i];
    } else if (std::abs(along_axes[i]) > tolerance_[i]) {
      return std::numeric_limits<double>::infinity();
    }
  }
  return sum;
}

double ErrorDensity::operator()(const Vec3& offset) const { return std::exp(-0.5 * squared_distance(offset)); }

std::vector<double> convolve(std::span<const double> utilities, const Candidates& candidates,
                             const PositioningError& error, const ConvolutionOptions& options) {
  options.validate();
  error.validate();
  require(utilities.size() == candidates.views.size(), "convolution: ", utilities.size(), " utilities for ",
          candidates.views.size(), " candidates");
  if (error.is_zero()) return {utilities.begin(), utilities.end()};
  if (!candidates.grid) return convolve_neighbours(utilities, candidates, error);
  if (error.is_diagonal()) return convolve_separably(utilities, *candidates.grid, error, options);
  return convolve_directly(utilities, *candidates.grid, error, options);
}

std::vector<double> convolve_each(std::span<const double> utilities, const Candidates& candidates,
                                  std::span<const PositioningError> error_of_candidate,
                                  const ConvolutionOptions& options) {
  options.validate();
  require(utilities.size() == candidates.views.size() && error_of_candidate.size() == candidates.views.size(),
          "convolution: ", utilities.size(), " utilities and ", error_of_candidate.size(), " errors for ",
          candidates.views.size(), " candidates");
  for (const PositioningError& error : error_of_candidate) error.validate();
  const std::optional<DenseGrid> dense =
      candidates.grid ? std::optional(spread(utilities, *candidates.grid)) : std::nullopt;
  std::vector<double> result(utilities.size());
  parallel_for(utilities.size(), [&](std::size_t v) {
    const PositioningError& error = error_of_candidate[v];
    if (error.is_zero()) {
      result[v] = utilities[v];
    } else if (dense) {
      result[v] = mean_around(candidates.grid->cell_of_view[v], *dense, *candidates.grid, error, options);
    } else {
      result[v] = mean_of_neighbours(v, utilities, candidates, ErrorDensity(error, Vec3::Constant(off_grid_tolerance)));
    }
  });
  return result;
}

}  // namespace vantage
