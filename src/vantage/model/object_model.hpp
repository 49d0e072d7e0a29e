#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "vantage/model/kept_scan.hpp"
#include "vantage/model/registrar.hpp"
#include "vantage/model/scan_graph.hpp"
#include "vantage/model/scan_record.hpp"
#include "vantage/robot/error_learner.hpp"
#include "vantage/sensor/sensor_model.hpp"

namespace vantage {

/// A scan that could not be registered yet.
struct WaitingScan {
  PoseEstimate prior;           // of its pose, as the robot says
  Box3 box;                     // around its points, by the mean of that
  std::int64_t known_near = 0;  // occupied voxels in the box when it was tried last
};

/// What is known of the object: the paper's M.
struct ObjectModel {
  VoxelMap map;
  ModelSurface surface;  // the fused cloud of all merged scans
  std::vector<ScanRecord> scans;
  SensorModel sensor;  // how the sensor errs, as far as that is known

  /// Of the scans whose poses are estimated, by their number: to be used again.
  std::map<int, KeptScan> kept;
  std::shared_ptr<ScratchFile> kept_in;  // made with the first
  std::map<int, PoseEstimate> priors;    // what the robot says, in its own frame
  std::map<int, WaitingScan> waiting;
  /// How the merged scans lie to each other, where their poses are estimated.
  ScanGraph graph;
  bool improves_poses = true;  // by the graph; otherwise each scan stays where it was merged
  /// Size of the fused cloud after each scan that was merged, in the order of merging: number and points.
  std::vector<std::pair<int, std::size_t>> cloud_growth;

  /// `point_spacing`: metres between the points that the fused cloud keeps.
  ObjectModel(const SceneOptions& scene, double point_spacing) : map(scene), surface(point_spacing) {}
};

/// Registers a scan and, where that succeeds, merges it into the model and relabels the map. A scan that is refused is
/// kept; earlier ones are tried again where the model has grown near them; and where several have been refused the
/// scans merged last are taken out again if more fit without them. After every few scans all poses are improved
/// together; where that moves surfaces visibly the map is made again. Returns the record of the scan with everything
/// that follows from the map; the caller adds the plan, the distance and the truth and puts it into model.scans.
[[nodiscard]] ScanRecord update(ObjectModel& model, const Scan& scan, const View& believed, Registrar& registrar,
                                QualityReference quality = QualityReference::axis);

/// When no scan follows: tries all waiting scans again that the model has grown near since, and improves all poses
/// together. The records say what came of it. Returns the numbers of the scans that came in.
std::vector<int> conclude(ObjectModel& model, Registrar& registrar, QualityReference quality = QualityReference::axis);

/// Voxels that came into the map after each scan, by its own points and by those of scans that came in with it.
[[nodiscard]] std::vector<std::int64_t> gains(const std::vector<ScanRecord>& scans);

/// Teaches the learner the error of a scan that was merged. True where the scan taught something: the first one defines
/// the frame that the others are registered in.
bool teach(ErrorLearner& learner, const ScanRecord& record);

}  // namespace vantage
