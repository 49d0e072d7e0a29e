#pragma once

#include <string>
#include <vector>

#include "vantage/report/report_data.hpp"
#include "vantage/report/software_renderer.hpp"
#include "vantage/runs/stored_run.hpp"

namespace vantage {

/// The run as a report shows it; `run` must outlive the result.
[[nodiscard]] ReportData report_data(const StoredRun& run);

/// A picture of a run.
struct RunPicture {
  std::string show = "views";  // see run_picture_subjects()
  int width = 1200, height = 800;
  double turn = 28;  // degrees around the object from -y towards +x
  double rise = 24;  // degrees above the horizon
  Vec3 up = Vec3::UnitZ();

  /// Throws InputError naming the field.
  void validate() const;
};

/// `views`: the model among its cameras; `model`: the surface, or else the cloud, or else the voxels; `quality`,
/// `normals`, `labels`: the occupied voxels coloured.
[[nodiscard]] std::vector<std::string> run_picture_subjects();

/// Throws InputError where the run has nothing of the kind to show.
[[nodiscard]] Picture draw(const StoredRun& run, const RunPicture& picture);

}  // namespace vantage
