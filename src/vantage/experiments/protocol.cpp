#include "vantage/experiments/protocol.hpp"

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr double voxel = 0.02;  // of the paper

const Protocol protocols[] = {
    {"paper", "80 views, 45x45 degrees, 320x320 pixels", "sphere:80:2", "45x45:320x320", voxel, 55, 205, {}, {}, 25},
    {"dense", "320 views, 45x45 degrees, 320x320 pixels", "sphere:320:2", "45x45:320x320", voxel, 55, 205, {}, {}, 25},
    {"coarse", "20 views, 45x45 degrees, 320x320 pixels", "sphere:20:2", "45x45:320x320", voxel, 55, 205, {}, {}, 25},
    // Jia, Li, Hao, Zhang: PB-NBV, 2025, and the program published with it: RealSense D435 from 0.9 m, objects of 0.3
    // m.
    {"pb-nbv",
     "after PB-NBV: 80 views at 0.9 m, 85.2x54.8 degrees, 640x360 pixels, objects of 0.3 m, 10 scans; "
     "coverage: 10,000 surface samples within 5 mm of the scans",
     "sphere:80:0.9", "85.2x54.8:640x360", 0.0075, 55, 205, 0.3, PointMetric{10'000, 0.005, false}, 10},
    // Pan, Wei: adaptive multi-resolution max-flow planning, 2022, and the program published with it: objects of about
    // 0.2 m, views from 2 to 4 radii, truth of 2 mm.
    {"max-flow",
     "after max-flow planning: 320 views at 0.3 m, 55.3x43 degrees, 320x240 pixels, objects of 0.2 m, voxels "
     "of 1 cm, 10 scans; coverage: 10,000 surface samples within 2 mm of the scans, of those that are reachable",
     "sphere:320:0.3", "55.3x43:320x240", 0.01, 27, 101, 0.2, PointMetric{10'000, 0.002, true}, 10},
};

}  // namespace

void Protocol::set(ReconstructOptions& options) const {
  options.candidates = candidates;
  options.camera = camera;
  options.voxel = voxel;
  options.enclosure = Index3::Constant(enclosure);
  options.scene = Index3::Constant(scene);
}

std::span<const Protocol> known_protocols() { return protocols; }

std::string names_of_protocols() {
  std::string names;
  for (const Protocol& each : known_protocols()) names += (names.empty() ? "" : ", ") + std::string(each.name);
  return names;
}

const Protocol& protocol_by_name(const std::string& name) {
  for (const Protocol& each : known_protocols()) {
    if (name == each.name) return each;
  }
  throw InputError(concat("protocol = '", name, "': must be one of: ", names_of_protocols()));
}

}  // namespace vantage
