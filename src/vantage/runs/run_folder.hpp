#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string_view>

#include "vantage/model/kept_scan.hpp"
#include "vantage/model/surface_volume.hpp"
#include "vantage/runs/output_folder.hpp"
#include "vantage/runs/run_data.hpp"
#include "vantage/runs/run_files.hpp"

namespace vantage {

/// What stays the same during a run.
struct RunDescription {
  std::string command;                                       // what makes it: reconstruct, plan
  std::string object;                                        // what people call it
  std::string program;                                       // version
  std::vector<std::pair<std::string, std::string>> options;  // name and value, in the order to be shown
  std::string config;                                        // config.yaml: all that is needed to repeat the run
  RangeCamera camera;
  Candidates candidates;
  std::string candidates_text;
  std::optional<TriangleMesh> truth;  // simulation only
  std::optional<std::uint64_t> seed;  // of what is random in the run
  /// Builds the surface from the scans, so that there is a mesh.
  std::optional<SurfaceOptions> surface;
  std::optional<SensorModel> sensor;  // what the surface weighs by; estimated where not known
};

/// The page that shows a finished run, for report.html. `seconds`: wall-clock time of the whole run.
using RunPage = std::function<std::string(const RunData& run, const VoxelMap& map, double seconds)>;

/// The output folder of a reconstruction (spec, section 10), which is the run's own while this lives (OutputFolder).
/// Scans are written as they are taken; the rest at the end. Every file appears under its name only when it is
/// complete.
class RunFolder {
 public:
  /// Creates the folder, or takes over that of an earlier run and removes what it wrote. Throws as OutputFolder does.
  RunFolder(const std::filesystem::path& path, RunDescription description, ForeignFiles foreign = ForeignFiles::refuse);

  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
  /// Hears all that a page needs to follow the run (docs/report-data.md, "Live"): `run` with the whole document at the
  /// first scan, `scan`, `plan`, and `result` and `state` at the end.
  std::function<void(std::string_view event, const nlohmann::ordered_json& data)> on_event;

  /// Where the candidates are known only after the scans: before add_plan() and finish().
  void set_candidates(Candidates candidates, std::string text);
  /// Notes a scan for the report and writes it to `scans/`: what the sensor measured, and the registered pose (the
  /// believed one where registration failed). `model` as it is after the scan.
  void add_scan(const ScanRecord& record, const Scan& scan, const ObjectModel& model, const Plan* plan);
  /// Tells of a plan that will lead to the next scan.
  void add_plan(const Plan& plan);
  /// Writes everything else: mesh.ply where the surface was built, report.html where there is a `page`.
  void finish(const ObjectModel& model, const RunSummary& summary, const std::optional<Plan>& next,
              double total_seconds, const RunPage& page);

 private:
  void add_to_surface(const ScanRecord& record, const Scan& scan, const VoxelMap& map);
  /// Of the scans that were kept, as their poses are known in the end.
  void make_surface_again(const ObjectModel& model);
  /// Returns how good the mesh is; nothing where there is none.
  [[nodiscard]] std::optional<MeshQuality> write_surface(const VoxelMap& map);

  OutputFolder folder_;
  RunDescription description_;
  RunData data_;
  std::optional<SurfaceVolume> surface_;
  /// As they were measured, where their poses may still be improved: the surface is made of them at the end.
  std::map<int, KeptScan> kept_;
  std::shared_ptr<ScratchFile> kept_in_;
};

/// The name of a run's scan in the folder `scans/`, without endings.
[[nodiscard]] std::string scan_file_name(int scan);

/// Points of the fused cloud that lie in the object's enclosure.
[[nodiscard]] PointCloud object_cloud(const ObjectModel& model);

}  // namespace vantage
