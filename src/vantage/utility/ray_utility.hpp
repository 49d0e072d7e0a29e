#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <tuple>
#include <utility>

#include "vantage/core/parallel.hpp"
#include "vantage/map/voxel_ray.hpp"
#include "vantage/utility/utility.hpp"

namespace vantage {

/// A voxel that a ray passes.
struct RayVoxel {
  Index3 index;  // scene
  Label label = Label::empty;
  double entered = 0;  // depth at which the ray enters it, metres; -infinity where the ray begins in it
};

/// The voxels of the enclosure that a ray passes, nearest first, up to and including the first occupied one or the far
/// limit.
using RayVoxels = std::span<const RayVoxel>;

/// Labels by local index, one byte each: faster to read one after the other than the map's bit planes.
class LabelTable {
 public:
  explicit LabelTable(const VoxelMap& map);
  [[nodiscard]] Label at(const Index3& scene_index) const {
    const Index3 local = scene_index - enclosure_.min;
    return labels_[(static_cast<std::size_t>(local.z()) * static_cast<std::size_t>(size_.y()) +
                    static_cast<std::size_t>(local.y())) *
                       static_cast<std::size_t>(size_.x()) +
                   static_cast<std::size_t>(local.x())];
  }

 private:
  IndexBox enclosure_;
  Index3 size_;
  std::vector<Label> labels_;
};

/// The resolution at which utilities along rays cast: the view's own, but never finer than the ideal one (eq. 14),
/// where every voxel is met already.
[[nodiscard]] Resolution ray_resolution(const ViewToJudge& view);

/// Calls `sum.add(voxels)` for every ray of a view that passes the enclosure, row by row.
template <class Sum>
void cast_rays(const Choice& choice, const LabelTable& labels, const ViewToJudge& view, Sum& sum) {
  const Grid& grid = choice.map.grid();
  const Resolution resolution = ray_resolution(view);
  const RayGrid rays = choice.camera.rays(resolution);
  const Mat3 rotation = view.view.world_from_sensor.linear();
  const Vec3 origin = view.view.position();
  const Index3 cell = grid.index_of(origin);
  std::vector<RayVoxel> passed;
  passed.reserve(static_cast<std::size_t>(choice.map.enclosure().size().sum()));
  for (int row = 0; row < resolution.rows; ++row) {
    for (int column = 0; column < resolution.columns; ++column) {
      passed.clear();
      const LatticeRay ray(origin, cell, ray_direction(rotation, rays.x(column), rays.y(row)));
      visit_voxels(grid, choice.map.enclosure(), ray, choice.camera.min_depth,
                   [&](const Index3& voxel, double entered) {
                     if (entered > choice.camera.max_depth) return false;
                     passed.push_back({voxel, labels.at(voxel), entered});
                     return passed.back().label != Label::occupied;
                   });
      if (!passed.empty()) sum.add(RayVoxels(passed));
    }
  }
}

/// What a utility along rays is made of: built for a view, told of its rays, asked for its value. `Shared` is built
/// once per choice from what the map alone decides.
template <class Sum>
concept RaySum = requires(Sum sum, const typename Sum::Shared& shared, const ViewToJudge& view, RayVoxels voxels) {
  {Sum(shared, view)};
  {sum.add(voxels)};
  { std::as_const(sum).value() } -> std::convertible_to<double>;
  {typename Sum::Shared(std::declval<const Choice&>())};
};

/// Several utilities along the same rays at once: value(i) is that of the i-th.
template <RaySum... Sums>
class RaySums {
 public:
  struct Shared {
    std::tuple<typename Sums::Shared...> each;
    explicit Shared(const Choice& choice) : each(typename Sums::Shared(choice)...) {}
  };
  RaySums(const Shared& shared, const ViewToJudge& view)
      : sums_(std::apply([&](const auto&... each) { return std::tuple<Sums...>(Sums(each, view)...); }, shared.each)) {}
  void add(RayVoxels voxels) {
    std::apply([&](auto&... sum) { (sum.add(voxels), ...); }, sums_);
  }
  [[nodiscard]] std::array<double, sizeof...(Sums)> value() const {
    return std::apply([](const auto&... sum) { return std::array<double, sizeof...(Sums)>{sum.value()...}; }, sums_);
  }

 private:
  std::tuple<Sums...> sums_;
};

/// Values of one or more sums for every view, from one traversal of its rays, in parallel over the views.
template <class Sum>
[[nodiscard]] auto sum_along_rays(const Choice& choice) {
  const typename Sum::Shared shared(choice);
  const LabelTable labels(choice.map);
  std::vector<decltype(std::declval<const Sum&>().value())> values(choice.views.size());
  parallel_for(values.size(), [&](std::size_t i) {
    Sum sum(shared, choice.views[i]);
    cast_rays(choice, labels, choice.views[i], sum);
    values[i] = sum.value();
  });
  return values;
}

template <RaySum Sum>
[[nodiscard]] Utility ray_utility() {
  return {.score = SetUtility([](const Choice& choice) { return sum_along_rays<Sum>(choice); })};
}

}  // namespace vantage
