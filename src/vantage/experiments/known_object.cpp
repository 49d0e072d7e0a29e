#include "vantage/experiments/known_object.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <tuple>

#include "vantage/core/parallel.hpp"
#include "vantage/simulation/mesh_tools.hpp"

namespace vantage {
namespace {

using Bits = std::vector<std::uint64_t>;

struct XFastest {
  bool operator()(const Index3& a, const Index3& b) const {
    return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
  }
};

double area_of_new(const KnownScans& scans, const Bits& held, const Bits& seen) {
  double sum = 0;
  for (std::size_t w = 0; w < held.size(); ++w) {
    for (std::uint64_t bits = seen[w] & ~held[w]; bits != 0; bits &= bits - 1) {
      sum += scans.area[64 * w + static_cast<std::size_t>(std::countr_zero(bits))];
    }
  }
  return sum;
}

void add(Bits& held, const Bits& seen) {
  for (std::size_t w = 0; w < held.size(); ++w) held[w] |= seen[w];
}

Bits held_by(const KnownScans& scans, const std::vector<int>& views) {
  Bits held(scans.of_view.front().size(), 0);
  for (const int view : views) add(held, scans.of_view[static_cast<std::size_t>(view)]);
  return held;
}

int best_next(const KnownScans& scans, const Bits& held) {
  int best = 0;
  double most = -1;
  for (std::size_t v = 0; v < scans.of_view.size(); ++v) {
    const double area = area_of_new(scans, held, scans.of_view[v]);
    if (area > most) {
      most = area;
      best = static_cast<int>(v);
    }
  }
  return best;
}

/// Exchanges views but the first as long as one exchange covers more.
double improve(const KnownScans& scans, std::vector<int>& views, double goal) {
  double covered = scans.covered(held_by(scans, views));
  for (bool better = true; better && covered < goal;) {
    better = false;
    for (std::size_t i = 1; i < views.size(); ++i) {
      std::vector<int> others = views;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const Bits held = held_by(scans, others);
      const int replacement = best_next(scans, held);
      others.push_back(replacement);
      const double area = scans.covered(held_by(scans, others));
      if (area > covered + 1e-12) {
        views = others;
        covered = area;
        better = true;
      }
    }
  }
  return covered;
}

/// Takes two views away and puts the best two back, for every pair, until the goal is reached.
double improve_pairs(const KnownScans& scans, std::vector<int>& views, double goal) {
  double covered = improve(scans, views, goal);
  for (bool better = true; better && covered < goal;) {
    better = false;
    for (std::size_t i = 1; i < views.size() && covered < goal; ++i) {
      for (std::size_t j = i + 1; j < views.size() && covered < goal; ++j) {
        std::vector<int> rest;
        for (std::size_t k = 0; k < views.size(); ++k) {
          if (k != i && k != j) rest.push_back(views[k]);
        }
        const Bits held = held_by(scans, rest);
        for (int first = 0; first < static_cast<int>(scans.of_view.size()); ++first) {
          Bits with_first = held;
          add(with_first, scans.of_view[static_cast<std::size_t>(first)]);
          const int second = best_next(scans, with_first);
          add(with_first, scans.of_view[static_cast<std::size_t>(second)]);
          const double area = scans.covered(with_first);
          if (area <= covered + 1e-12) continue;
          covered = area;
          views = rest;
          views.push_back(first);
          views.push_back(second);
          better = true;
        }
        if (better) break;
      }
      if (better) break;
    }
    if (better) covered = std::max(covered, improve(scans, views, goal));
  }
  return covered;
}

/// The first stays first, then always the nearest one left.
std::vector<int> nearest_first(std::vector<int> views, const std::vector<View>& candidates, const Vec3& center) {
  const auto place = [&](int view) { return candidates[static_cast<std::size_t>(view)].position(); };
  for (std::size_t i = 1; i < views.size(); ++i) {
    const auto nearer = [&](int a, int b) {
      const Vec3 from = place(views[i - 1]);
      return std::pair(angle_seen_from(center, from, place(a)), a) <
             std::pair(angle_seen_from(center, from, place(b)), b);
    };
    std::iter_swap(views.begin() + static_cast<std::ptrdiff_t>(i),
                   std::min_element(views.begin() + static_cast<std::ptrdiff_t>(i), views.end(), nearer));
  }
  return views;
}

std::vector<double> greedy_scores(const KnownScans& scans, const Choice& choice) {
  Bits held(scans.of_view.front().size(), 0);
  for (std::size_t i = 0; i < scans.voxels.size(); ++i) {
    if (choice.map.label(scans.voxels[i]) == Label::occupied) held[i / 64] |= std::uint64_t{1} << (i % 64);
  }
  std::vector<double> scores;
  for (const ViewToJudge& view : choice.views) {
    scores.push_back(area_of_new(scans, held, scans.of_view[static_cast<std::size_t>(view.candidate)]));
  }
  return scores;
}

}  // namespace

double KnownScans::covered(const std::vector<std::uint64_t>& held) const {
  return area_of_new(*this, std::vector<std::uint64_t>(held.size(), 0), held);
}

KnownScans known_scans(const SimulatedObject& object, const ReconstructOptions& options) {
  const SceneOptions scene = options.scene_options();
  const Grid grid = scene.grid();
  const RangeCamera camera = options.range_camera();
  const std::vector<View> views = options.candidate_views().views;
  constexpr int samples = 200'000;
  Random random(1);
  std::map<Index3, std::size_t, XFastest> number;
  KnownScans scans;
  std::size_t visible = 0;
  for (const MeshSample& sample : sample_surface(object.scanner().mesh(), samples, random)) {
    const Index3 voxel = grid.index_of(sample.point);
    if (!scene.enclosure().contains(voxel) || !object.truth().is_visible(voxel)) continue;
    const auto [at, is_new] = number.emplace(voxel, number.size());
    if (is_new) scans.area.push_back(0);
    scans.area[at->second] += 1;
    ++visible;
  }
  scans.voxels.resize(number.size());
  for (const auto& [voxel, i] : number) scans.voxels[i] = voxel;
  for (double& area : scans.area) area /= static_cast<double>(std::max<std::size_t>(visible, 1));
  scans.of_view.assign(views.size(), Bits((number.size() + 63) / 64, 0));
  parallel_for(views.size(), [&](std::size_t v) {
    const RangeImage image = object.scanner().scan(camera, views[v]);
    const RayGrid rays = camera.rays();
    for (int row = 0; row < camera.resolution.rows; ++row) {
      for (int column = 0; column < camera.resolution.columns; ++column) {
        const float depth = image.at(column, row);
        if (!RangeImage::is_hit(depth)) continue;
        const Vec3 point = views[v].world_from_sensor * point_in_sensor(rays, column, row, static_cast<double>(depth));
        const auto found = number.find(grid.index_of(point));
        if (found == number.end()) continue;
        scans.of_view[v][found->second / 64] |= std::uint64_t{1} << (found->second % 64);
      }
    }
  });
  return scans;
}

std::vector<int> smallest_cover(const KnownScans& scans, int start, double goal) {
  std::vector<int> best{start};
  while (scans.covered(held_by(scans, best)) < goal && best.size() < scans.of_view.size()) {
    best.push_back(best_next(scans, held_by(scans, best)));
  }
  while (best.size() > 2) {
    std::vector<int> fewer(best.begin(), best.end() - 1);
    if (improve_pairs(scans, fewer, goal) < goal) break;
    best = fewer;
  }
  return best;
}

Utility known_greedy_utility(const SimulatedObject& object, const ReconstructOptions& options) {
  const auto scans = std::make_shared<const KnownScans>(known_scans(object, options));
  return {.score = SetUtility([scans](const Choice& choice) { return greedy_scores(*scans, choice); }),
          .needs_all_views = true,
          .skips_scanned_views = true};
}

Utility known_optimum_utility(const SimulatedObject& object, const ReconstructOptions& options, double goal) {
  const auto scans = std::make_shared<const KnownScans>(known_scans(object, options));
  const Candidates candidates = options.candidate_views();
  // A little above the goal, because the scans' coverage is measured by other samples.
  const std::vector<int> order =
      nearest_first(smallest_cover(*scans, options.initial_view, goal + 2e-4), candidates.views, candidates.center);
  const auto score = [scans, order](const Choice& choice) {
    // As many scans are done as views of the order are used up.
    std::vector<double> scores = greedy_scores(*scans, choice);
    const std::size_t done = choice.scanned.size();
    if (done >= order.size()) return scores;
    for (std::size_t i = 0; i < scores.size(); ++i) scores[i] = choice.views[i].candidate == order[done] ? 2 : 0;
    return scores;
  };
  return {.score = SetUtility(score), .needs_all_views = true, .skips_scanned_views = true};
}

}  // namespace vantage
