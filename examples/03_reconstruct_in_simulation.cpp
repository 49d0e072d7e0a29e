// The whole loop in simulation: a robot that misses by 3 cm scans a mug, ICP finds out where it really was, the planner
// says where to look next.

#include <cstdio>

#include "vantage/simulation/objects.hpp"
#include "vantage/simulation/simulate.hpp"

using namespace vantage;

int main() {
  ReconstructOptions options;
  options.camera = "45x45:160x160";
  options.positioning_error = Vec3::Constant(0.03);
  options.registration = "icp";
  options.max_views = 8;

  const SimulatedObject mug(make_object("mug"), default_size("mug"), options);
  RunObserver observer;
  observer.on_scan = [](const ScanRecord& record, const Scan&, const ObjectModel&, const Plan*) {
    const double error = (record.registered.position() - record.true_view->position()).norm();
    std::printf("scan %d from view %2d: %5.1f %% of what can be seen, pose within %.1f mm (%s); %s\n", record.scan,
                record.candidate, 100 * *record.coverage, 1000 * error, record.verdict.c_str(), record.reason.c_str());
  };

  const SimulatedRun run = simulate(mug, options, observer);
  const ScanRecord& last = run.model.scans.back();
  std::printf("%s; %.1f %% covered after %zu scans and %.1f m of travel\n", run.stop_reason.c_str(),
              100 * *last.coverage, run.model.scans.size(), last.distance);
  return *last.coverage > 0.9 ? 0 : 1;
}
