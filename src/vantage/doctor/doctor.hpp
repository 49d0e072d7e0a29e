#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vantage/doctor/finding.hpp"
#include "vantage/model/from_scans.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage {

struct DoctorOptions {
  ScanFolderOptions folder;                                 // how the scans would be read
  std::optional<Eigen::Matrix<double, 6, 1>> box;           // where the object should be: cx cy cz sx sy sz, metres
  double pose_error = ScanPlanOptions::default_pose_error;  // metres; what registration would search

  /// Throws InputError naming the option.
  void validate() const;
};

template <class Field>
void describe(DoctorOptions& o, Field&& field) {
  field("box", o.box, "m", "where the object is: cx,cy,cz,sx,sy,sz; not checked if not given");
  field("pose-error", o.pose_error, "m", "how far off the poses may be at most");
  describe(o.folder, field);
}

/// What is wrong with a set of scans.
struct Diagnosis {
  std::size_t frames = 0;             // looked at
  std::size_t every = 1;              // of which only every n-th was, where there are many
  std::size_t all_frames = 0;         // of the set, also those that were not looked at
  std::string recognised;             // ScanSet
  std::vector<std::string> left_out;  // ScanSet
  double agreement = 0;               // between the frames as given, 0..1; 0 where the poses cannot be read at all
  double contradiction = 0;           // of what the frames both look at as given, 0..1
  bool not_compared = false;          // fewer than two frames: what takes a comparison was not checked
  double best_agreement = 0;          // as they are best explained
  std::vector<std::string> checks;    // what was looked at, by name
  std::vector<Finding> findings;

  [[nodiscard]] bool healthy() const {
    return std::all_of(findings.begin(), findings.end(), [](const Finding& finding) { return finding.is_note; });
  }
};

/// Names of all checks, in the order in which they are made, and what each looks for.
struct CheckName {
  const char* name;
  const char* looks_for;
};
[[nodiscard]] const std::vector<CheckName>& doctor_checks();

/// Examines the scans at `path` as open_scans() would read them. `progress` gets a line about what is being done.
/// Throws InputError for what open_scans() refuses, except for poses that it can fix itself to look on.
[[nodiscard]] Diagnosis examine(const std::filesystem::path& path, const DoctorOptions& options,
                                const std::function<void(const std::string&)>& progress);

}  // namespace vantage
