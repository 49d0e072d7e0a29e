#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <mutex>

#include "vantage/model/surface_volume.hpp"
#include "vantage/runs/run_folder.hpp"
#include "vantage/session/session_folder.hpp"
#include "vantage/session/session_model.hpp"

namespace vantage {

/// What a session plans, and the state that it was planned on.
struct SessionPlan {
  std::shared_ptr<const SessionState> state;
  std::optional<Plan> plan;
  std::string why_finished;  // where there is no plan
};

/// How a session stands.
struct SessionStatus {
  std::size_t stored = 0, integrated = 0, merged = 0;
  std::shared_ptr<const SessionState> state;
  std::map<int, std::string> skipped;
  std::set<int> removed;                // scans that were taken out
  std::map<int, std::string> left_out;  // scans that are safe on disk but could not be read or merged, with the reason
  std::vector<std::string> dropped;     // what opening it left out
  std::vector<std::string> warnings;    // what could not be written or shown since
};

/// A reconstruction that lives in a folder over hours and restarts: scans are added to it and views asked of it.
///
/// Every scan is safe on disk before its number is given out. Any thread may call any member at any time: scans are
/// registered one after the other in the order of their numbers, and next() and status() answer from the last one that
/// was integrated, without waiting for a registration. The same scans give the same map and plans to the last bit,
/// whether they come at once or with restarts between them, and the same as `plan`. A scan whose merging fails by an
/// exception (no memory) is left out, and merged when the session opens again; the others are not touched by it.
class Session {
 public:
  /// Makes a session of the folder. The options must have a box. Throws InputError naming the option, or where the
  /// folder already is a session.
  static void create(const std::filesystem::path& folder, const ScanPlanningOptions& options);
  /// Opens a session and merges its scans again where they were registered before. Throws InputError where it is none,
  /// Error where another process has it open.
  /// `on_scan` is called with the model after each scan, those merged again while opening too, in the thread that
  /// merges; next() and status() know of the scan by then. After remove() and restore() the calls start again, with a
  /// model of one scan, and next() and status() know of them once the last was merged. What it throws becomes a
  /// warning: the model stays as it is.
  using OnScan = std::function<void(const SessionModel&)>;
  explicit Session(
      const std::filesystem::path& folder, OnScan on_scan = [](const SessionModel&) {});

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] const ScanPlanningOptions& options() const { return folder_.options(); }

  /// Writes the scan to disk and returns its number; integrate() merges it. Where a scan with its key is there already,
  /// nothing is written and that number returned: whoever got no answer may send again. Throws InputError where the
  /// scan is not valid, Error where it could not be written; then it is not part of the session.
  int store(SessionScan scan);
  /// Registers and merges the stored scans up to this number, unless another thread does. Returns the record of it.
  /// Throws Error where it was left out.
  ScanRecord integrate(int number);
  /// Both.
  ScanRecord add(SessionScan scan) { return integrate(store(std::move(scan))); }

  /// A scan that the session has already with the same measurements and pose, unless different keys say that it is
  /// another one.
  [[nodiscard]] std::optional<int> same_scan(const SessionScan& scan);
  /// Takes a scan out of the session, as if it had never come: those after it are registered again without it. Its file
  /// is kept. Throws InputError where there is no such scan.
  void remove(int number);
  /// Takes remove() back. Throws InputError where no such scan was taken out.
  void restore(int number);

  /// The views to take next, planned on the last integrated map.
  [[nodiscard]] SessionPlan next();
  /// The view of this candidate is not planned again: it could not be reached, or somebody does not want it.
  void skip(int candidate, const std::string& reason);
  /// Takes skip() back.
  void unskip(int candidate);
  [[nodiscard]] SessionStatus status();
  /// The fused cloud in the box; waits for a registration that goes on.
  [[nodiscard]] PointCloud cloud();
  /// The surface in the box, from the last integrated scans; those that came since the call before are added to it.
  [[nodiscard]] MeasuredMesh mesh();
  /// What finish() writes: the model as it stands, or one in which refused scans were tried once more and all poses
  /// improved together. The session itself stays as it is.
  enum class Ending { as_it_stands, concluded };
  /// Writes model, mesh, map, views.csv, summary.json and report.html into the folder (spec, section 10). Scans may be
  /// added during that and after it. Throws InputError where files of these names are there that no session wrote,
  /// unless they are to be overwritten.
  void finish(const RunPage& page, ForeignFiles foreign = ForeignFiles::refuse, Ending ending = Ending::as_it_stands);

 private:
  struct Waiting {
    int number;
    SessionScan scan;
  };

  /// A scan that surface_ has seen, and where it was then.
  struct FusedScan {
    int number = 0;
    bool merged = false;
    Eigen::Matrix4d world_from_sensor = Eigen::Matrix4d::Identity();
    bool operator==(const FusedScan&) const = default;
  };

  void replay();
  void note_identity(const Waiting& waiting);
  [[nodiscard]] std::optional<Waiting> next_waiting(int up_to);
  void integrate_one(const Waiting& waiting, const std::optional<Located>& known);
  void tell_follower(const SessionModel& model);
  void store_located(int number, const Located& found);
  void leave_out(int number, const std::string& why);
  void warn(const std::string& what);
  void merge_again(std::vector<int> numbers);
  void publish();
  void change_skipped(int candidate, const std::optional<std::string>& reason);
  [[nodiscard]] std::shared_ptr<const SessionState> state() const;

  // Locked in this order: the files that finish() writes; the surface; the model; the plan that was made last; the
  // folder and the scans that wait to be merged; and, for moments only, what everybody looks at.
  std::mutex finishing_, meshing_, merging_, planning_, storing_;
  mutable std::mutex looking_;

  SessionFolder folder_;
  OnScan on_scan_;
  std::deque<Waiting> waiting_;
  std::map<std::string, int> number_of_key_;
  std::multimap<std::string, int> numbers_of_content_;  // by checksum
  std::unique_ptr<SessionModel> model_;
  bool model_is_whole_ = true;  // no merging broke off in the middle of a scan
  std::optional<SurfaceVolume> surface_;
  std::vector<FusedScan> fused_;
  std::optional<SessionPlan> plan_;
  std::map<int, std::string> skipped_of_plan_;

  std::shared_ptr<const SessionState> state_;
  std::map<int, std::string> skipped_, left_out_;
  std::set<int> removed_;
  std::size_t stored_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace vantage
