#include "vantage/doctor/doctor.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "vantage/core/error.hpp"
#include "vantage/doctor/box.hpp"
#include "vantage/doctor/explain.hpp"
#include "vantage/doctor/frames.hpp"
#include "vantage/doctor/no_return.hpp"
#include "vantage/doctor/pose_errors.hpp"
#include "vantage/doctor/pose_files.hpp"
#include "vantage/doctor/readable_poses.hpp"

namespace vantage {
namespace {

ScanFolderOptions without_limits(ScanFolderOptions options) {
  // In a wrong unit everything may lie beyond the limits.
  options.depth_range = {0, 1e6};
  options.crop.reset();  // what is outside does not count, but the sensor saw it
  return options;
}

/// Images whose size the intrinsics have the other way round cannot be read at all.
std::variant<ScanSet, Finding> opened(const std::filesystem::path& path, const ScanFolderOptions& options) {
  try {
    return open_scans(path, options);
  } catch (const ResolutionError& error) {
    return Finding{"intrinsics", error.what(),
                   "write width and height as those of the images, or give the intrinsics of these images",
                   "the images cannot be read with them"};
  }
}

/// Depths and positions in the same wrong unit fit each other.
std::vector<Finding> check_size(const Evidence& evidence, const Reading& reading) {
  constexpr double farthest = 150;  // metres: no sensor that reconstructs objects
  const double depth = reading.depth_of(evidence.median_depth(), Eigen::Vector2d::Zero());
  if (depth < farthest) return {};
  return {{"depth-unit", concat("everything is very large: the typical depth is ", depth, " m"),
           "if the numbers are millimetres give --unit mm (and --depth-scale for images of whole numbers)",
           "frames fit each other, which they do in any unit"}};
}

/// The poses of the frames that have a point.
void take_poses(Evidence& evidence, const ScanSet& set) {
  auto frame = evidence.frames.begin();
  for (const ScanFile& scan : set.scans) {
    if (frame == evidence.frames.end()) break;
    if (frame->name != scan.name) continue;
    frame->world_from_sensor = scan.view.world_from_sensor;
    ++frame;
  }
}

}  // namespace

void DoctorOptions::validate() const {
  folder.validate();
  ScanPlanOptions plan;
  plan.box = box;
  plan.pose_error = pose_error;
  plan.validate();
}

const std::vector<CheckName>& doctor_checks() {
  static const std::vector<CheckName> checks{
      {"frames", "frames without a point; sets of one frame"},
      {"rotation", "matrices that are scaled, mirrored, transposed or no rotations; quaternions with w first"},
      {"depth-unit", "depths in another unit than --depth-scale says"},
      {"position-unit", "positions in another unit than --unit says"},
      {"depth-kind", "distances along the ray, or disparities, instead of depths"},
      {"pose-direction", "camera from world instead of world from camera"},
      {"sensor-axes", "body or OpenGL axes instead of x right, y down, z forward"},
      {"hand-eye", "poses of the robot's hand instead of the sensor"},
      {"time", "poses that belong to earlier or later frames"},
      {"intrinsics", "intrinsics of images of another size; cx and cy swapped"},
      {"pose-errors", "frames farther off than registration searches"},
      {"box", "a box that no frame has a point in"},
      {"no-return", "a sensor that does not tell where nothing is, or reports it where it measured nothing"}};
  return checks;
}

Diagnosis examine(const std::filesystem::path& path, const DoctorOptions& options,
                  const std::function<void(const std::string&)>& progress) {
  options.validate();
  options.folder.require_poses();
  Diagnosis diagnosis;
  ReadablePoses poses(path, options.folder);
  diagnosis.findings = poses.findings();
  for (const CheckName& check : doctor_checks()) diagnosis.checks.emplace_back(check.name);
  if (!poses.readable()) return diagnosis;
  const auto add = [&](const std::vector<Finding>& more) {
    diagnosis.findings.insert(diagnosis.findings.end(), more.begin(), more.end());
  };

  const ScanFolderOptions reading = without_limits(options.folder);
  std::variant<ScanSet, Finding> first = opened(path, poses.options(reading, 0));
  if (const auto* finding = std::get_if<Finding>(&first)) {
    add({*finding});
    return diagnosis;
  }
  Evidence evidence;
  Explained best;
  for (int way = 0; way < poses.readings(); ++way) {
    const ScanSet set = way == 0 ? std::get<ScanSet>(std::move(first)) : open_scans(path, poses.options(reading, way));
    if (way == 0) {
      diagnosis.recognised = set.description;
      diagnosis.left_out = set.left_out;
      evidence = gather(set, options.folder.depth_range[1], options.folder,
                        [&](std::size_t done, std::size_t of) { progress(concat("reads frame ", done, " of ", of)); });
      diagnosis.frames = evidence.frames.size() + evidence.empty.size();
      diagnosis.every = evidence.every;
      diagnosis.all_frames = set.scans.size();
      add(check_frames(evidence));
      if (evidence.frames.size() < 2) {
        add(check_no_return(evidence));
        diagnosis.not_compared = true;
        return diagnosis;
      }
    }
    take_poses(evidence, set);
    Explained explained = explain(evidence, options.folder.metres_per_depth_unit(), progress);
    // A mirrored axis and a half turn on top look like another mirrored axis: of equals the one with less to fix.
    const double more_to_fix =
        static_cast<double>(explained.findings.size()) - static_cast<double>(best.findings.size());
    if (way == 0 || explained.consistency.score() > best.consistency.score() + 0.02 * more_to_fix) {
      best = std::move(explained);
      if (poses.readings() > 1) diagnosis.findings.back().fix = poses.fix(way);
    }
  }
  diagnosis.agreement = poses.findings().empty() ? best.given.agrees : 0;
  diagnosis.contradiction = best.given.contradiction();
  diagnosis.best_agreement = best.consistency.agrees;
  add(best.findings);
  add(check_size(evidence, best.reading));
  progress("compares frames with each other by registration");
  add(check_pose_errors(evidence, best.reading, options.pose_error));
  if (options.box) add(check_box(evidence, best.reading, *options.box));
  add(check_no_return(evidence));
  return diagnosis;
}

}  // namespace vantage
