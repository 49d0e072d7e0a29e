#include "vantage/utility/field_utilities.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vantage/core/parallel.hpp"
#include "vantage/core/random.hpp"
#include "vantage/robot/travel.hpp"
#include "vantage/utility/information.hpp"

namespace vantage {
namespace {

double mean_lack_of_quality(const VoxelMap& map, std::span<const Index3> voxels) {
  double sum = 0;
  int occupied = 0;
  for (const Index3& voxel : voxels) {
    const SurfaceVoxel* surface = map.surface(voxel);
    if (surface == nullptr) continue;
    sum += 1 - surface->quality;
    ++occupied;
  }
  return occupied > 0 ? sum / occupied : 0;
}

bool is_boundary(const VoxelMap& map, const Index3& voxel) {
  if (!is_unknown(map.label(voxel))) return false;
  for (int a = 0; a < 3; ++a) {
    for (const int step : {-1, 1}) {
      Index3 neighbour = voxel;
      neighbour[a] += step;
      if (map.label(neighbour) == Label::empty) return true;
    }
  }
  return false;
}

}  // namespace

Utility massios_fisher_utility() {
  const auto judge_all = [](const Choice& choice) {
    int most = 0;
    for (const ViewToJudge& view : choice.views) most = std::max(most, view.seen.occplane);
    std::vector<double> scores(choice.views.size());
    parallel_for(scores.size(), [&](std::size_t i) {
      const ViewToJudge& view = choice.views[i];
      const std::vector<Index3> voxels = choice.visibility.visible_voxels(choice.camera, view.view, view.resolution);
      const double visibility = most > 0 ? static_cast<double>(view.seen.occplane) / most : 0;
      scores[i] = 0.5 * visibility + 0.5 * mean_lack_of_quality(choice.map, voxels);
    });
    return scores;
  };
  return {.score = SetUtility(judge_all), .skips_scanned_views = true};
}

Utility sanchiz_fisher_utility() {
  const auto count = [](const Visibility& seen, const Factors&) {
    const double unknown = static_cast<double>(seen.occplane) + seen.unmarked;
    return unknown + std::min<double>(seen.occupied, unknown);
  };
  return {.score = CountUtility(count), .skips_scanned_views = true};
}

Utility blaer_allen_utility() {
  Utility utility = voxel_utility([](const Choice& choice, const ViewToJudge&, std::span<const Index3> voxels) {
    return static_cast<double>(std::count_if(voxels.begin(), voxels.end(),
                                             [&](const Index3& voxel) { return is_boundary(choice.map, voxel); }));
  });
  utility.skips_scanned_views = true;
  return utility;
}

Utility random_utility() {
  const auto draw = [](const Choice& choice) {
    std::vector<double> scores;
    for (const ViewToJudge& view : choice.views) {
      // A stream per candidate: what a view draws does not depend on which others are left.
      Random random(choice.seed, 0x72616e64U + static_cast<std::uint64_t>(view.candidate));
      scores.push_back(1 - random.uniform());
    }
    return scores;
  };
  return {.score = SetUtility(draw), .skips_scanned_views = true};
}

Utility uniform_utility() {
  const auto spread = [](const Choice& choice) {
    const Vec3 center = choice.map.enclosure_center();
    std::vector<double> scores;
    for (const ViewToJudge& view : choice.views) {
      double nearest = std::numbers::pi;
      for (const View& scanned : choice.scanned) {
        nearest = std::min(nearest, angle_seen_from(center, scanned.position(), view.view.position()));
      }
      // Rounded, so that rounding does not decide between views that lie alike.
      scores.push_back(std::round(nearest * 1e6) / 1e6);
    }
    return scores;
  };
  return {.score = SetUtility(spread), .skips_scanned_views = true};
}

}  // namespace vantage
