// Takes a simulated scan, registers the same scan taken from a pose that is 5 mm off, and writes the cloud: a call into
// several components.
#include <cstdio>
#include <vantage/formats/point_cloud_file.hpp>
#include <vantage/map/scan.hpp>
#include <vantage/model/registrar.hpp>
#include <vantage/simulation/objects.hpp>
#include <vantage/simulation/range_scanner.hpp>

using namespace vantage;

int main() {
  const RangeScanner scanner(make_object("mug"));
  const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {160, 160});
  const View view = view_towards({0, -2, 0.5}, Vec3::Zero());
  const Scan frame = scan_of(scanner.scan(camera, view));
  const PointCloud scan = points_of(frame);

  ModelSurface model(0.005);
  model.merge(scan, view.world_from_sensor);
  model.merge(*IcpRegistrar().surface_of(frame, scan, view), view.world_from_sensor);
  View believed = view;
  believed.world_from_sensor.pretranslate(Vec3(0.005, 0, 0));
  const Located located = IcpRegistrar().locate(model, frame, scan, believed);
  const double error = (located.view.position() - view.position()).norm();
  std::printf("%zu points, %s, pose within %.2f mm\n", scan.size(), located.verdict.c_str(), 1000 * error);

  write_cloud_ply("scan.ply", scan);
  return located.accepted && error < 0.0025 && read_cloud("scan.ply").cloud.size() == scan.size() ? 0 : 1;
}
