#include "vantage/model/unposed.hpp"

#include "vantage/core/error.hpp"
#include "vantage/model/registrar.hpp"
#include "vantage/registration/unposed_scans.hpp"

namespace vantage {
namespace {

/// In front of real sensors people and robots move, and without poses nobody knows where the object is that stands
/// still.
constexpr double outlier_share = 0.05;

std::string note_of(const std::string& name, const UnposedScan& scan) {
  if (scan.rank == 0U) return concat(name, ": begins");
  std::string note = concat(name, ": ", scan.world_from_sensor ? "found" : "NOT FOUND, ",
                            scan.world_from_sensor ? std::string_view() : vantage::name(scan.found.verdict), ": ",
                            scan.found.explanation);
  if (!scan.world_from_sensor && !scan.alternatives.empty())
    note += concat("; it fits in ", scan.alternatives.size() + 1, " poses");
  return note;
}

}  // namespace

FoundScans with_found_poses(const std::vector<PendingScan>& scans, const SensorOptions& sensor) {
  RegistrarOptions options;
  options.sensor = sensor.given();
  const IcpRegistrar registrar(options);
  std::vector<ScanSurface> surfaces;
  surfaces.reserve(scans.size());
  for (const PendingScan& each : scans) {
    const Scan scan = each.read();
    surfaces.push_back(*registrar.surface_of(scan, points_of(scan), each.believed));
  }
  AnywhereOptions anywhere;
  anywhere.registration.outlier_share = outlier_share;
  const std::vector<UnposedScan> found = find_poses(surfaces, anywhere);
  FoundScans result;
  result.notes.resize(scans.size());
  std::vector<const UnposedScan*> in_order(scans.size(), nullptr);
  std::size_t count = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    result.notes[i] = note_of(scans[i].name, found[i]);
    const UnposedScan& scan = found[i];
    if (scan.rank) in_order[*scan.rank] = &scan;
    count += scan.rank ? 1 : 0;
  }
  require(count >= 2 || scans.size() < 2, "poses = none: no two of the ", scans.size(),
          " scans fit together; neighbouring scans must show a third of the same surface. ", result.notes.back());
  for (std::size_t rank = 0; rank < count; ++rank) {
    const UnposedScan& scan = *in_order[rank];
    result.scans.push_back(scans[static_cast<std::size_t>(&scan - found.data())]);
    result.scans.back().believed = View{scan.world_from_sensor.value_or(Pose::Identity())};
  }
  return result;
}

}  // namespace vantage
