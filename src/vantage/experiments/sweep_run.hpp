#pragma once

#include <functional>
#include <memory>
#include <string>

#include "vantage/core/error.hpp"
#include "vantage/experiments/run_outcome.hpp"
#include "vantage/experiments/sweep_object.hpp"

namespace vantage {

/// Asked now and then by a run; true means that nobody waits for its outcome any more.
using Interrupted = std::function<bool()>;

/// Thrown by a run that was interrupted: nothing is stored of it.
class RunInterrupted : public Error {
 public:
  RunInterrupted() : Error("interrupted") {}
};

/// One independent piece of work of a sweep. Runs with the same configuration have the same outcome, so they are done
/// once and shared, within an experiment, between experiments and with earlier starts of the program.
struct SweepRun {
  std::string name;           // for people and file names: "mug, exhaustive, start 8"
  std::string configuration;  // JSON text of all that decides the outcome
  std::function<RunOutcome(const Interrupted&)> work;
  /// Runs that measure time want the machine alone: they come last, on rank 0, one at a time, with all its threads.
  enum class Place { anywhere, alone };
  Place place = Place::anywhere;
};

/// More that is to be measured of every reconstruction, beyond what reconstruction_run() does by itself.
struct ExtraMeasures {
  std::string name;  // enters the configuration: change it whenever `add` changes what it writes
  std::function<void(const SimulatedRun&, const SimulatedObject&, RunOutcome&)> add;
  /// Made for every run and told of its scans, after the lists below have got their entries.
  using OnScan = std::function<void(const ScanRecord&, const Scan&, RunOutcome&)>;
  std::function<OnScan(const SweepObject&, const ReconstructOptions&)> per_scan = {};
  /// Made for every run, instead of the utility that the options name; `name` must tell which it is.
  std::function<Utility(const SimulatedObject&, const ReconstructOptions&)> utility = {};
};

/// A simulated reconstruction. Its outcome has the numbers `views`, `occupied`, `quality`, `distance`, `coverage`,
/// `coverage_all`, `failed_scans` (never merged), `refused_scans` (not at once), `recovered_scans` (later), the text
/// `stop_reason`, per scan the lists `coverage`, `coverage_all`, `occupied`,
/// `new_occupied`, `quality`, `distance` (up to the scan), `candidate`, `n_oc`, `n_op`, `n_um`, `utility` (as planned,
/// NaN for the first), `overlap` (share of the scan's voxels that were occupied before), `registration_overlap`,
/// `residual`, and as they are when the run has ended `merged` and `merged_at_once` (1 or 0), `register_probability`
/// (as planned, NaN where it was not), `position_error` [m], `orientation_error` [rad] (registered against true pose)
/// and `pose_error` [m] (mean distance of the scan's points from where they should be), and the times `plan`,
/// `registration`, `integration` per scan.
[[nodiscard]] SweepRun reconstruction_run(const std::string& name, std::shared_ptr<const SweepObject> object,
                                          const ReconstructOptions& options, const ExtraMeasures& extra = {});

}  // namespace vantage
