#include "vantage/registration/sample_choice.hpp"

#include <algorithm>
#include <array>

namespace vantage {
namespace {

constexpr int bins_per_axis = 4;

std::size_t bin_of(const Vec3& normal) {
  std::size_t bin = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int part = std::clamp(static_cast<int>((normal[axis] + 1) / 2 * bins_per_axis), 0, bins_per_axis - 1);
    bin = bin * bins_per_axis + static_cast<std::size_t>(part);
  }
  return bin;
}

}  // namespace

std::vector<SurfaceSample> picked_evenly(std::span<const SurfaceSample> all, std::size_t most) {
  std::vector<SurfaceSample> picked;
  const std::size_t count = std::min(most, all.size());
  picked.reserve(count);
  for (std::size_t i = 0; i < count; ++i) picked.push_back(all[i * all.size() / count]);
  return picked;
}

std::vector<SurfaceSample> picked_by_normal(std::span<const SurfaceSample> all, std::size_t most) {
  std::array<std::vector<std::size_t>, bins_per_axis * bins_per_axis * bins_per_axis> bins;
  for (std::size_t i = 0; i < all.size(); ++i) bins[bin_of(all[i].normal)].push_back(i);
  std::stable_sort(bins.begin(), bins.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  std::vector<SurfaceSample> picked;
  std::size_t left = std::min(most, all.size());
  picked.reserve(left);
  // The small ones first: what they do not use goes to the larger ones.
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const std::size_t count = std::min(bins[b].size(), left / (bins.size() - b));
    for (std::size_t i = 0; i < count; ++i) picked.push_back(all[bins[b][i * bins[b].size() / count]]);
    left -= count;
  }
  return picked;
}

}  // namespace vantage
