#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vantage/core/point_cloud.hpp"
#include "vantage/core/triangle_mesh.hpp"
#include "vantage/model/reconstruction.hpp"
#include "vantage/options/reconstruct_options.hpp"

namespace vantage {

/// What one scan changed in the map (docs/report-data.md). Voxels are counted in the enclosure, x fastest.
struct MapChange {
  std::vector<std::uint8_t> labels;   // per voxel: 0 = as before, otherwise 1 + label
  std::vector<std::uint32_t> voxels;  // occupied voxels whose surface changed, ascending
  std::vector<std::int8_t> normals;   // three per voxel of `voxels`, times 127
  std::vector<std::uint8_t> quality;  // per voxel of `voxels`, times 255
};

/// Finds out what each scan changed, by comparing the map with how it was at the call before (unmarked at first).
class MapRecorder {
 public:
  [[nodiscard]] MapChange changes(const VoxelMap& map);

 private:
  std::vector<Label> labels_;
  std::vector<SurfaceVoxel> surfaces_;  // in the order of the occupied voxels
  std::vector<std::uint32_t> occupied_;
};

/// What the planner found out about all candidates at one moment.
struct CandidatePlan {
  std::optional<int> chosen;
  std::vector<Evaluation> evaluations;  // by candidate; those not evaluated have no rays
  bool convolved = false;               // the scores are expected utilities, others than the utilities
};

/// The plan's evaluations in the order of the candidates.
[[nodiscard]] CandidatePlan candidate_plan(const Plan& plan, std::size_t candidates);

/// A scan as the page shows it.
struct RecordedScan {
  ScanRecord record;
  std::optional<CandidatePlan> plan;  // that chose this scan; nothing for the first
  MapChange change;
};

/// A whole run as report.html and the live page show it: docs/report-data.md in C++.
struct RunData {
  enum class State { running, waiting, finished };

  std::string command;  // reconstruct, plan, session
  std::string object;   // what people call it
  std::string program;  // version
  std::vector<std::pair<std::string, std::string>> options;
  std::optional<std::uint64_t> seed;
  bool simulated = false;  // coverage and truth mean something
  State state = State::finished;

  Grid grid;
  IndexBox enclosure;
  RangeCamera camera;
  Candidates candidates;
  std::string candidates_text;  // as on the command line

  std::vector<RecordedScan> scans;
  std::optional<CandidatePlan> next;  // made after the last scan
  std::string stop_reason;

  PointCloud cloud;                          // fused; empty: none
  std::vector<std::uint16_t> scan_of_point;  // the scan that brought each point of `cloud`; empty: not known
  TriangleMesh mesh;                         // reconstructed; empty: none
  TriangleMesh truth;                        // empty: none
  std::string static_html;                   // pictures for readers without JavaScript; may be empty

  /// Adds a scan; `model` as it is after it, `plan` that chose it or nullptr.
  void add_scan(const ScanRecord& record, const ObjectModel& model, const Plan* plan);
  /// Takes the fused cloud and the records of the finished model, what changed since the last scan, and notes why the
  /// run ended.
  void finish(const ObjectModel& model, const std::string& reason);

 private:
  MapRecorder recorder_;
};

/// The data of a simulated reconstruction before its first scan: scene, camera, candidates and the options that matter,
/// those that differ from the defaults among them. `program` is the version, `truth` the placed mesh.
[[nodiscard]] RunData run_data(const ReconstructOptions& options, const std::string& object, const std::string& program,
                               const TriangleMesh& truth);

}  // namespace vantage
