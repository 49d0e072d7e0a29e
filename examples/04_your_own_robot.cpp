// How to connect hardware: a class with three functions. This one is a turntable with a camera on a fixed arm, which
// can look down at the object but never up, and whose scans come from a formula instead of a sensor.

#include <cmath>
#include <cstdio>

#include "vantage/model/reconstruction.hpp"

using namespace vantage;

namespace {

constexpr double ball_radius = 0.1;

class Turntable : public Robot {
 public:
  explicit Turntable(const RangeCamera& camera) : camera_(camera) {}

  bool move_to(const View& view) override {
    // The planner does not know this limit; `move_to` says so here, and it plans another view.
    if (view.position().z() < -0.05) return false;
    view_ = view;
    return true;
  }

  RangeImage take_range_image() override {
    RangeImage image{camera_, {}};
    const RayGrid rays = camera_.rays();
    for (int row = 0; row < camera_.resolution.rows; ++row) {
      for (int column = 0; column < camera_.resolution.columns; ++column) {
        const Vec3 direction = ray_direction(view_.world_from_sensor.linear(), rays.x(column), rays.y(row));
        const double a = direction.squaredNorm();
        const double b = view_.position().dot(direction);
        const double c = view_.position().squaredNorm() - ball_radius * ball_radius;
        const double discriminant = b * b - a * c;
        image.depth.push_back(discriminant >= 0 ? static_cast<float>((-b - std::sqrt(discriminant)) / a)
                                                : RangeImage::no_return);
      }
    }
    return image;
  }

  View view() const override { return view_; }

 private:
  RangeCamera camera_;
  View view_;
};

}  // namespace

int main() {
  const SceneOptions scene{
      .voxel_length = 0.01, .scene_size = Index3::Constant(101), .enclosure_size = Index3::Constant(31)};
  ObjectModel model(scene, 0.0025);
  const RangeCamera camera = camera_from_apertures(radians(45), radians(45), {120, 120});
  const Candidates candidates = view_sphere(80, 0.7, model.map.enclosure_center());

  Turntable robot(camera);
  Planner planner(candidates, camera);
  TrustingRegistrar registrar;  // a turntable knows where it is
  Reconstruction reconstruction(robot, planner, registrar);
  reconstruction.on_scan = [](ScanRecord& record, const Scan&, const ObjectModel&, const Plan*) {
    std::printf("scan %d from view %2d, height %5.2f m: %lld new voxels\n", record.scan, record.candidate,
                record.believed.position().z(), static_cast<long long>(record.new_occupied));
  };
  int first = 0;
  while (candidates.views[static_cast<std::size_t>(first)].position().z() < 0.2) ++first;
  reconstruction.run(model, first);
  std::printf("finished: %s\n", reconstruction.stop_reason().c_str());

  bool stayed_above = true;
  for (const ScanRecord& scan : model.scans) stayed_above &= scan.believed.position().z() >= -0.05;
  return stayed_above && model.scans.size() > 2 ? 0 : 1;
}
