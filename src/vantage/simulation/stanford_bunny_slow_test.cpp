// The real scans of the Stanford bunny: disturbed poses register back.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "vantage/core/parallel.hpp"
#include "vantage/core/random.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/recordings/scan_folder.hpp"
#include "vantage/registration/registration.hpp"
#include "vantage/simulation/range_scanner.hpp"

namespace vantage {
namespace {

const std::filesystem::path folder = std::filesystem::path(VANTAGE_SHARED_DATA) / "scans/stanford_bunny";

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct BunnyScan {
  std::string name;
  PointCloud cloud;
  ScanSurface surface;
  Pose truth = Pose::Identity(), believed = Pose::Identity(), found = Pose::Identity();
  std::string why_not = {};
  bool is_registered = false;
};

std::vector<BunnyScan> disturbed_scans(double shift, double angle, std::uint64_t seed) {
  Random random(seed);
  std::vector<BunnyScan> scans;
  for (const ScanFile& file : open_scans(folder).scans) {
    const Scan lines = file.read();
    BunnyScan scan{.name = file.name, .cloud = points_of(lines), .surface = {}, .truth = file.view.world_from_sensor};
    scan.surface = scan_surface(scan.cloud, std::get<PointScan>(lines).origins, std::nullopt);
    scan.believed = scan.truth;
    if (!scans.empty()) {
      scan.believed.translation() += shift * random.unit_vector();
      scan.believed.linear() = Eigen::AngleAxisd(angle, random.unit_vector()).toRotationMatrix() * scan.truth.linear();
    }
    scan.found = scan.believed;
    scans.push_back(std::move(scan));
  }
  return scans;
}

/// Median distance of the scan's points to the reference surface, metres.
double median_distance(const BunnyScan& scan, const Pose& world_from_sensor, const RangeScanner& reference) {
  std::vector<double> distances(scan.cloud.size() / 10);
  parallel_for(distances.size(), [&](std::size_t i) {
    distances[i] = reference.distance(world_from_sensor * scan.cloud.points[10 * i]);
  });
  return median(distances);
}

TEST(StanfordBunny, DisturbedPosesRegisterBackBelowAMillimetre) {
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  std::vector<BunnyScan> scans = disturbed_scans(0.02, radians(3), 1);
  ASSERT_EQ(scans.size(), 10U);
  const RangeScanner reference(read_mesh(folder / "bun_zipper.ply"));
  EXPECT_LT(median_distance(scans[0], scans[0].truth, reference), 0.0003);  // the frames are read rightly

  RegisteredSurface model;
  model.merge(scans[0].surface, scans[0].truth);
  scans[0].is_registered = true;
  // A scan that does not overlap the model yet is tried again when the model has grown.
  for (bool has_grown = true; has_grown;) {
    has_grown = false;
    for (BunnyScan& scan : scans) {
      if (scan.is_registered) continue;
      const Registration registration =
          register_scan(model, scan.surface, PoseEstimate::around(scan.believed, 0.02, radians(3)));
      scan.why_not = registration.explanation;
      if (!registration.succeeded()) continue;
      scan.found = registration.world_from_sensor;
      scan.is_registered = has_grown = true;
      model.merge(scan.surface, scan.found);
    }
  }
  for (const BunnyScan& scan : scans) {
    EXPECT_TRUE(scan.is_registered) << scan.name << ": " << scan.why_not;
    const double before = median_distance(scan, scan.believed, reference);
    const double after = median_distance(scan, scan.found, reference);
    std::printf("%s: median distance %.2f mm before, %.2f mm after\n", scan.name.c_str(), 1e3 * before, 1e3 * after);
    EXPECT_LT(after, 0.001) << scan.name;
  }
}

}  // namespace
}  // namespace vantage
