// A robot client: opens a session in a folder of its own, adds two scans of a plate, and asks for the next view; a
// server for the same session is made but not started. It must need neither Embree nor MPI (check.cmake).
#include <cstdio>
#include <filesystem>
#include <vantage/server/http_server.hpp>
#include <vantage/server/session_service.hpp>
#include <vantage/session/session.hpp>

using namespace vantage;

namespace {

/// What a camera at `position` measures of a square plate of 0.4 m that faces it in the middle of the world.
SessionScan plate_from(const Vec3& position) {
  const View view = view_towards(position, Vec3::Zero());
  const Vec3 normal = position.normalized();
  RangeImage image{camera_from_apertures(radians(45), radians(45), {40, 40}), {}};
  image.camera.max_depth = 4.5;
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 40; ++column) {
      const Vec3 ray = view.world_from_sensor.linear() * point_in_sensor(image.camera.rays(), column, row, 1);
      const double depth = -normal.dot(position) / normal.dot(ray);
      const bool meets = (position + depth * ray).cwiseAbs().maxCoeff() < 0.2;
      image.depth.push_back(meets ? static_cast<float>(depth) : RangeImage::no_return);
    }
  }
  return {"scan", view, scan_of(std::move(image)), std::nullopt};
}

}  // namespace

int main() {
  const std::filesystem::path folder = "consumer-session";
  std::filesystem::remove_all(folder);
  ScanPlanningOptions options;
  options.scene.box = Eigen::Matrix<double, 6, 1>{{0.0, 0.0, 0.0, 1.0, 1.0, 1.0}};
  options.scene.voxel = 0.1;
  options.scene.views = 20;
  options.scene.registration = "none";
  Session::create(folder, options);

  LiveRun page;
  SessionService service(folder, page);
  service.session().add(plate_from({0, -2, 0}));
  service.session().add(plate_from({2, 0, 0}));
  const SessionPlan next = service.session().next();
  const SessionStatus status = service.session().status();
  std::printf("%zu scans, next view %d\n", status.merged, next.plan ? next.plan->best.candidate : -1);
  service.stop();
  return next.plan && next.plan->best.score > 0 ? 0 : 1;
}
