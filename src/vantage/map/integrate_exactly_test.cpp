#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "vantage/core/random.hpp"
#include "vantage/map/integrate.hpp"
#include "vantage/map/voxel_ray.hpp"

namespace vantage {
namespace {

/// Steps to the end of a line: to its hit's voxel, or to the first voxel entered after its end, by walking the planes.
int steps_to_end(const Grid& grid, const LatticeRay& ray, const SightLine& line) {
  if (line.is_hit) return (grid.index_of(line.hit_point()) - ray.origin_cell).cwiseAbs().sum();
  int steps = 1;
  for (int a = 0; a < 3; ++a) {
    if (ray.step_along(a) == 0) continue;
    for (int k = ray.origin_cell[a] + ray.step_along(a); ray.enter(grid, a, k) <= line.end; k += ray.step_along(a)) {
      ++steps;
    }
  }
  return steps;
}

/// What the evidence says, voxel by voxel.
void count_naively(VoxelMap& map, const std::vector<SightLine>& lines) {
  const Grid& grid = map.grid();
  std::map<std::tuple<int, int, int>, int> amounts;  // of this scan
  const auto key = [](const Index3& voxel) { return std::tuple(voxel.x(), voxel.y(), voxel.z()); };
  for (const SightLine& line : lines) {
    const Index3 voxel = grid.index_of(line.hit_point());
    if (!line.is_hit || !map.enclosure().contains(voxel)) continue;
    int& amount = amounts[key(voxel)];
    const int more = line.normal.isZero(0) ? 1 : 2;
    const int counted = std::min(amount + more, 2) - amount;
    amount += counted;
    const VoxelMap::Supported supported = map.support(voxel, counted);
    if (supported.surface != nullptr && !line.normal.isZero(0)) supported.surface->add(line.normal, line.quality);
  }
  const IndexBox box = map.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        const Index3 voxel(x, y, z);
        int passing = 0;
        int through = 0;
        for (const SightLine& line : lines) {
          const LatticeRay ray(grid, line.origin, line.direction);
          if (!passes_voxel(grid, ray, voxel, line.near, LatticeRay::never)) continue;
          ++passing;
          if ((voxel - ray.origin_cell).cwiseAbs().sum() + 3 < steps_to_end(grid, ray, line)) ++through;
        }
        const Index3 local = voxel - box.min;
        if (passing > 0 && through == passing) map.contradict_word(map.layout().word(local), BitLayout::bit(local));
      }
    }
  }
}

/// Spec, section 1, voxel by voxel: no traversal, only the closed-form test of a ray against a voxel.
void integrate_naively(VoxelMap& map, const std::vector<SightLine>& lines) {
  const Grid& grid = map.grid();
  std::vector<Index3> hits;
  for (const SightLine& line : lines) {
    if (line.is_hit && map.enclosure().contains(grid.index_of(line.hit_point()))) {
      hits.push_back(grid.index_of(line.hit_point()));
      if (map.rule() == MapRule::paper) map.add_point(hits.back(), line.normal, line.quality);
    }
  }
  if (map.rule() == MapRule::evidence) count_naively(map, lines);
  const IndexBox box = map.enclosure();
  const auto steps = [](const Index3& a, const Index3& b) { return (a - b).cwiseAbs().sum(); };
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        const Index3 voxel(x, y, z);
        bool crossed_before_end = false;
        bool crossed_behind_hit = false;
        for (const SightLine& line : lines) {
          const LatticeRay ray(grid, line.origin, line.direction);
          if (!line.is_hit) {
            crossed_before_end |= passes_voxel(grid, ray, voxel, line.near, line.end);
          } else if (passes_voxel(grid, ray, voxel, line.near, LatticeRay::never)) {
            const Index3 hit = grid.index_of(line.hit_point());
            const int to_voxel = steps(voxel, ray.origin_cell);
            const int to_hit = steps(hit, ray.origin_cell);
            crossed_before_end |= to_voxel < to_hit;
            crossed_behind_hit |= to_voxel > to_hit && box.contains(hit);
          }
        }
        const Label before = map.label(voxel);
        if (before == Label::occupied) continue;
        if (crossed_before_end) {
          map.set_label(voxel, Label::empty);
        } else if (crossed_behind_hit && before == Label::unmarked) {
          map.set_label(voxel, Label::occluded);
        }
      }
    }
  }
  for (const Index3& hit : hits) {
    if (map.label(hit) == Label::unmarked) map.set_label(hit, Label::occluded);
  }
  map.update_occplane();
}

TEST(IntegrateExactly, DoesWhatTheSpecSaysVoxelByVoxel) {
  Random random(51);
  int scans = 0;
  std::array<std::int64_t, 5> seen{};
  int contradicted = 0;
  for (int scene = 0; scene < 150; ++scene) {
    const Grid grid{Vec3::Constant(-1), random.uniform() < 0.5 ? 0.25 : 0.21, Index3(9, 10, 8)};
    const IndexBox enclosure{Index3(1, 0, 2), Index3(6, 7, 6)};
    const MapRule rule = scene % 2 == 0 ? MapRule::paper : MapRule::evidence;
    VoxelMap map(grid, enclosure, rule);
    VoxelMap naive(grid, enclosure, rule);
    for (int scan = 0; scan < 3; ++scan) {
      const auto awkward = [&](double scale) {
        const double value = random.uniform(-scale, scale);
        return random.uniform() < 0.5 ? value : std::round(value * 4) / 4;
      };
      std::vector<SightLine> lines;
      for (int i = 0; i < 25; ++i) {
        SightLine line;
        line.origin = Vec3(awkward(3), awkward(3), awkward(3));
        line.direction = Vec3(awkward(1), awkward(1), awkward(1)) - line.origin;
        if (line.direction.isZero(0)) continue;
        line.near = random.uniform() < 0.7 ? 0 : random.uniform(0, 1);
        line.is_hit = random.uniform() < 0.6;
        line.end = random.uniform() < 0.5 ? 1 : random.uniform(0.1, 2.5);
        if (random.uniform() < 0.8) {
          line.normal = random.unit_vector();
          line.quality = random.uniform();
        }
        lines.push_back(line);
      }
      integrate_exactly(map, lines);
      integrate_naively(naive, lines);
      ++scans;
      for (int z = 0; z < 8; ++z) {
        for (int y = 0; y < 10; ++y) {
          for (int x = 0; x < 9; ++x) {
            const Index3 voxel(x, y, z);
            ASSERT_EQ(name(map.label(voxel)), name(naive.label(voxel)))
                << "scene " << scene << ": " << voxel.transpose();
            ASSERT_EQ(map.evidence(voxel), naive.evidence(voxel)) << "scene " << scene << ": " << voxel.transpose();
            ++seen.at(static_cast<std::size_t>(map.label(voxel)));
            if (map.evidence(voxel).contradiction > map.evidence(voxel).support) ++contradicted;
          }
        }
      }
    }
  }
  EXPECT_EQ(scans, 450);
  EXPECT_GT(contradicted, 20);
  for (const Label label : all_labels) EXPECT_GT(seen.at(static_cast<std::size_t>(label)), 50) << name(label);
}

/// A row of five voxels of 1 m along x; the ray starts at x = -2.5 in voxel -3.
struct Row {
  VoxelMap map{Grid{Vec3::Zero(), 1, Index3(7, 1, 1)}, IndexBox{Index3(0, 0, 0), Index3(4, 0, 0)}};

  IntegrationReport hit_at(double x) {
    SightLine line;
    line.origin = Vec3(-2.5, 0.5, 0.5);
    line.direction = Vec3::UnitX();
    line.end = x + 2.5;
    line.is_hit = true;
    return integrate_exactly(map, std::vector{line});
  }
  void no_return_until(double x) {
    SightLine line;
    line.origin = Vec3(-2.5, 0.5, 0.5);
    line.direction = Vec3::UnitX();
    line.end = x + 2.5;
    integrate_exactly(map, std::vector{line});
  }
  [[nodiscard]] std::string labels() const {
    std::string text;
    for (int x = 0; x < 5; ++x) text += "?#.xo"[static_cast<int>(map.label({x, 0, 0}))];
    return text;
  }
};

TEST(IntegrateExactly, BeforeTheHitEmptyBehindItHidden) {
  Row row;
  const IntegrationReport report = row.hit_at(2.5);
  EXPECT_EQ(row.labels(), "..#oo") << "a row one voxel thick has empty neighbours everywhere";
  EXPECT_EQ(report.points_in_enclosure, 1);
  EXPECT_EQ(report.new_occupied, 1);
}

TEST(IntegrateExactly, OccupiedIsNeverDowngraded) {
  Row row;
  row.hit_at(1.5);
  row.hit_at(3.5);
  EXPECT_EQ(row.labels(), ".#.#o");
}

TEST(IntegrateExactly, AHitBehindTheEnclosureFreesItsPath) {
  Row row;
  const IntegrationReport report = row.hit_at(6.5);
  EXPECT_EQ(row.labels(), ".....");
  EXPECT_EQ(report.points_in_enclosure, 0);
}

TEST(IntegrateExactly, AHitBeforeTheEnclosureLabelsNothing) {
  Row row;
  row.hit_at(-1.5);
  EXPECT_EQ(row.labels(), "?????");
}

TEST(IntegrateExactly, NoReturnFreesUpToTheFarLimit) {
  Row row;
  row.no_return_until(2.5);
  EXPECT_EQ(row.labels(), "...??");
}

/// The same row by evidence. Points have a normal unless they are stray.
struct EvidenceRow {
  VoxelMap map{Grid{Vec3::Zero(), 1, Index3(12, 1, 1)}, IndexBox{Index3(0, 0, 0), Index3(9, 0, 0)}, MapRule::evidence};

  IntegrationReport hit_at(double x, const Vec3& normal = -Vec3::UnitX()) {
    SightLine line;
    line.origin = Vec3(-2.5, 0.5, 0.5);
    line.direction = Vec3::UnitX();
    line.end = x + 2.5;
    line.is_hit = true;
    line.normal = normal;
    // A scan has stray points where other points of it have normals: one far from the row.
    SightLine elsewhere = line;
    elsewhere.origin.y() = 9.5;
    elsewhere.normal = -Vec3::UnitX();
    return integrate_exactly(map, std::vector{line, elsewhere});
  }
  [[nodiscard]] std::string labels() const {
    std::string text;
    for (int x = 0; x < 10; ++x) text += "?#.xo"[static_cast<int>(map.label({x, 0, 0}))];
    return text;
  }
  [[nodiscard]] VoxelEvidence at(int x) const { return map.evidence({x, 0, 0}); }
};

TEST(Evidence, APointOnASurfaceMakesAVoxelOccupied) {
  EvidenceRow row;
  EXPECT_EQ(row.hit_at(2.5).new_occupied, 1);
  EXPECT_EQ(row.labels(), "..#ooooooo");
  EXPECT_EQ(row.at(2), (VoxelEvidence{2, 0}));
}

TEST(Evidence, OneStrayPointIsNotEnoughTwoAre) {
  EvidenceRow row;
  EXPECT_EQ(row.hit_at(2.5, Vec3::Zero()).new_occupied, 0);
  EXPECT_EQ(row.labels(), "..oooooooo") << "something may be there";
  EXPECT_EQ(row.hit_at(2.6, Vec3::Zero()).new_occupied, 1);
  EXPECT_EQ(row.labels(), "..#ooooooo");
}

TEST(Evidence, MoreScansThroughThanOnItEmptyAVoxel) {
  EvidenceRow row;
  row.hit_at(2.5);
  EXPECT_EQ(row.hit_at(8.5).taken_back, 0) << "one against one";
  EXPECT_EQ(row.labels(), "..#.....#o");
  EXPECT_EQ(row.hit_at(8.5).taken_back, 1);
  EXPECT_EQ(row.labels(), "........#o");
  EXPECT_EQ(row.at(2), (VoxelEvidence{2, 4}));
  EXPECT_EQ(row.hit_at(2.5).new_occupied, 1) << "two against two";
  EXPECT_EQ(row.map.surface({2, 0, 0})->normal(), -Vec3::UnitX());
}

TEST(Evidence, AHitJustBehindDoesNotSpeakAgainstAVoxel) {
  EvidenceRow row;
  row.hit_at(2.5);
  for (int i = 0; i < 5; ++i) row.hit_at(5.5);
  EXPECT_EQ(row.at(2), (VoxelEvidence{2, 0}));
  row.hit_at(6.5);
  EXPECT_EQ(row.at(2), (VoxelEvidence{2, 2}));
}

TEST(Evidence, ScansBeforeTheFirstPointCountAsOne) {
  EvidenceRow row;
  for (int i = 0; i < 5; ++i) row.hit_at(8.5);
  row.hit_at(2.5);
  EXPECT_EQ(row.at(2), (VoxelEvidence{2, 2}));
  EXPECT_EQ(row.labels(), "..#.....#o");
  row.hit_at(8.5);
  EXPECT_EQ(row.labels(), "........#o");
}

TEST(Evidence, CountsSaturateInFavourOfTheSurface) {
  EvidenceRow row;
  for (int i = 0; i < 200; ++i) row.hit_at(2.5);
  for (int i = 0; i < 200; ++i) row.hit_at(8.5);
  EXPECT_EQ(row.at(2), (VoxelEvidence{254, 254}));
  EXPECT_EQ(row.labels(), "..#.....#o");
}

}  // namespace
}  // namespace vantage
