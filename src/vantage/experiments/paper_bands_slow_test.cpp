#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "vantage/core/parallel.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/simulation/objects.hpp"
#include "vantage/simulation/simulate.hpp"

namespace vantage {
namespace {

/// A row of tables 1 and 2 of the paper, and the width of its quality band (spec, section 9).
struct PaperRow {
  const char* object;
  double size;
  double views, occupied, quality, distance_exhaustive, distance_multi_resolution;
  double quality_multi_resolution, quality_band;
};

constexpr std::array<PaperRow, 7> paper{{
    {"sphere", 0.815, 6, 7200, .757, 17.70, 17.70, .757, .09},
    {"pear", 0.815, 7, 4330, .803, 16.40, 16.40, .803, .09},
    {"banana", 0.815, 4, 1050, .803, 9.54, 7.15, .765, .09},
    {"mug", 0.815, 8, 7736, .718, 21.76, 21.76, .718, .09},
    {"bunny", 0.815, 9, 5392, .825, 21.32, 23.56, .825, .09},
    {"dragon", 0.815, 9, 3595, .777, 24.46, 22.14, .798, .13},
    {"sgi_logo", 1.09, 12, 11952, .843, 34.02, 32.53, .843, .09},
}};
constexpr int starts = 10;

/// Means over the initial views.
struct Means {
  double views = 0, occupied = 0, quality = 0, distance = 0, coverage = 0;
};

Means reconstruct_from_all_starts(const TriangleMesh& mesh, double size, const std::string& search) {
  ReconstructOptions options;
  options.search = search;
  const SimulatedObject object(mesh, size, options);
  std::array<Means, starts> runs;
  parallel_for(starts, [&](std::size_t i) {
    ReconstructOptions mine = options;
    mine.initial_view = static_cast<int>(80 / starts * i);
    const SimulatedRun run = simulate(object, mine);
    const ScanRecord& last = run.model.scans.back();
    runs[i] = {static_cast<double>(run.model.scans.size()), static_cast<double>(last.labels.occupied),
               last.mean_quality, last.distance, *last.coverage};
  });
  Means sum;
  for (const Means& run : runs) {
    sum.views += run.views / starts;
    sum.occupied += run.occupied / starts;
    sum.quality += run.quality / starts;
    sum.distance += run.distance / starts;
    sum.coverage += run.coverage / starts;
  }
  return sum;
}

void expect_in_bands(const PaperRow& row, const std::string& source, const TriangleMesh& mesh, double size) {
  for (const std::string search : {"exhaustive", "multi-resolution"}) {
    const bool exhaustive = search == "exhaustive";
    const double quality = exhaustive ? row.quality : row.quality_multi_resolution;
    const Means ours = reconstruct_from_all_starts(mesh, size, search);
    fmt::print(
        "{:<9} {:<10} {:<16} views {:5.1f} ({:2.0f})  occupied {:7.1f} ({:5.0f})  quality {:.3f} ({:.3f})  "
        "distance {:6.2f} ({:5.2f})  coverage {:.2f} %\n",
        row.object, source, search, ours.views, row.views, ours.occupied, row.occupied, ours.quality, quality,
        ours.distance, exhaustive ? row.distance_exhaustive : row.distance_multi_resolution, 100 * ours.coverage);
    const std::string which = fmt::format("{} ({}), {}", row.object, source, search);
    EXPECT_GE(ours.views, row.views - 3) << which;
    EXPECT_LE(ours.views, row.views + 2) << which;
    EXPECT_NEAR(ours.occupied, row.occupied, 0.05 * row.occupied) << which;
    EXPECT_NEAR(ours.quality, quality, row.quality_band) << which;
    EXPECT_NEAR(ours.distance, row.distance_exhaustive, 0.25 * row.distance_exhaustive) << which;
    EXPECT_GE(ours.coverage, 0.992) << which;
  }
}

TEST(PaperTables1And2, BuiltInObjectsLandInTheBands) {
  for (const PaperRow& row : paper) {
    const auto names = object_names();
    if (std::find(names.begin(), names.end(), row.object) == names.end()) continue;
    expect_in_bands(row, "built in", make_object(row.object), default_size(row.object));
  }
}

TEST(PaperTables1And2, TheOriginalMeshesLandInTheBands) {
  const std::filesystem::path folder = std::filesystem::path(VANTAGE_SHARED_DATA) / "objects";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " with the paper's objects is not there";
  for (const PaperRow& row : paper) {
    if (std::string(row.object) == "sphere") continue;  // has no file: it is built in
    expect_in_bands(row, "file", read_mesh(folder / fmt::format("{}.ply", row.object)), row.size);
  }
}

}  // namespace
}  // namespace vantage
