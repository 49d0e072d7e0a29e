#include "vantage/session/session.hpp"

#include <mutex>

#include "bindings.hpp"
#include "depth_input.hpp"
#include "options.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/recordings/scan_folder.hpp"
#include "vantage/report/static_report.hpp"

namespace vantage::python {
namespace {

/// A session that can be closed before Python forgets it. Calls that go on in other threads end first.
class OpenSession {
 public:
  explicit OpenSession(const std::filesystem::path& folder) : session_(std::make_shared<Session>(folder)) {}

  [[nodiscard]] std::shared_ptr<Session> get() const {
    const std::lock_guard lock(mutex_);
    require(session_ != nullptr, "session: is closed");
    return session_;
  }
  void close() {
    std::shared_ptr<Session> last;
    const std::lock_guard lock(mutex_);
    last.swap(session_);
  }
  [[nodiscard]] bool is_open() const {
    const std::lock_guard lock(mutex_);
    return session_ != nullptr;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<Session> session_;
};

std::unique_ptr<OpenSession> new_session(const std::filesystem::path& folder, const py::kwargs& keywords) {
  ScanPlanningOptions options;
  std::set<std::string> given;
  set_options(noting(option_fields(options), given), keywords, "Session.new");
  const py::gil_scoped_release release;
  load_robot(options.planning, given);
  Session::create(folder, options);
  return std::make_unique<OpenSession>(folder);
}

ScanRecord add_scan(const OpenSession& session, const ScanHolder& scan, const View& believed, const std::string& name,
                    std::optional<int> candidate, const std::optional<View>& commanded) {
  return session.get()->add({name, believed, scan.scan, candidate, commanded});
}

/// Nothing where the session does not learn.
std::optional<py::dict> learned_error(const SessionStatus& status) {
  const std::optional<ErrorLearner>& learner = status.state->learner;
  if (!learner) return std::nullopt;
  const PoseError error = learner->estimate();
  py::dict result;
  result["observations"] = learner->observations();
  result["left_out"] = learner->left_out();
  result["mean"] = error.mean;
  result["covariance"] = error.covariance;
  return result;
}

ScanRecord add_depth(const OpenSession& session, const py::array& depth, const DoubleArray& intrinsics,
                     const Pose& pose, const std::vector<double>& distortion, const std::optional<py::array>& mask,
                     const std::string& name, std::optional<int> candidate) {
  const auto open = session.get();
  auto [scan, view] = read_depth({depth, intrinsics, distortion, mask}, pose, open->options().reading);
  const py::gil_scoped_release release;
  return open->add({name, view, std::move(scan), candidate});
}

std::vector<ScanRecord> add_files(const OpenSession& session, const std::filesystem::path& path,
                                  std::optional<int> candidate, const py::kwargs& keywords) {
  ScanFolderOptions reading = session.get()->options().reading;
  set_options(option_fields(reading), keywords, "Session.add_files");
  const py::gil_scoped_release release;
  reading.require_poses();
  const ScanSet set = open_scans(path, reading);
  require(!candidate || set.scans.size() == 1, "candidate = ", candidate.value_or(0), ": is for one scan, there are ",
          set.scans.size());
  std::vector<ScanRecord> records;
  for (const ScanFile& file : set.scans) {
    SessionScan scan{file.name, file.view, file.read(), candidate};
    if (const std::optional<int> same = session.get()->same_scan(scan)) {
      const py::gil_scoped_acquire acquire;
      const std::string text = concat("left out ", file.name, ", which is there already as scan ", *same);
      if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
      continue;
    }
    records.push_back(session.get()->add(std::move(scan)));
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return records;
}

SessionPlan next(const OpenSession& session) {
  const py::gil_scoped_release release;
  return session.get()->next();
}

void bind_status(py::module_& module) {
  py::class_<SessionStatus>(module, "SessionStatus", "How a session stands.")
      .def_readonly("stored", &SessionStatus::stored, "Scans that are safe on disk.")
      .def_readonly("integrated", &SessionStatus::integrated, "Scans that were registered, with or without success.")
      .def_readonly("merged", &SessionStatus::merged, "Scans that are in the map.")
      .def_readonly("removed", &SessionStatus::removed, "Numbers of the scans that were taken out.")
      .def_readonly("skipped", &SessionStatus::skipped, "Candidates that are not planned: {index: reason}.")
      .def_readonly("dropped", &SessionStatus::dropped, "What opening the session left out, a sentence each.")
      .def_readonly("warnings", &SessionStatus::warnings, "What could not be written since, a sentence each.")
      .def_property_readonly(
          "radius", [](const SessionStatus& status) { return status.state->radius; },
          "Of the sphere of candidate views, metres.")
      .def_property_readonly(
          "distance",
          [](const SessionStatus& status) {
            return status.state->scans.empty() ? 0.0 : status.state->scans.back().distance;
          },
          "Travelled so far, metres.")
      .def_property_readonly(
          "learned_error", &learned_error,
          "What the scans from planned views have taught of the robot's error, where believed_error is 'learn', else "
          "None: a dict of observations, left_out (taken for registrations that went wrong), mean (6,) and covariance "
          "(6, 6) of x, y, z, pan, tilt and roll, metres and radians.")
      .def("__repr__", [](const SessionStatus& status) {
        return concat("<vantage.SessionStatus: ", status.stored, " scans stored, ", status.merged, " merged>");
      });
}

}  // namespace

void bind_session(py::module_& module) {
  using Release = py::call_guard<py::gil_scoped_release>;
  bind_status(module);
  ScanPlanningOptions defaults;
  const std::string help =
      "A reconstruction in a folder, over hours and across restarts: scans are added to it and views asked of it. "
      "Every "
      "scan is safe on disk before add() returns, and the same scans give the same map and plans as `vantage plan` and "
      "`vantage session`, which may go on with the folder. One process at a time. Any thread may call any member.\n\n"
      "Session(folder) opens one that is there, Session.new(folder, box=..., ...) makes one; `with` closes it.";
  const std::string new_help =
      "Makes a session of a folder and opens it. Options by keyword, as those of `vantage session new`; box is "
      "required:\n\n" +
      options_text(option_fields(defaults));
  ScanFolderOptions reading;
  const std::string files_help =
      "Adds scans as `vantage session add` does: a depth frame or cloud with its pose beside it, a folder of them, or "
      "a Stanford .conf. Those that are there already with the same measurements and pose are left out, with a "
      "warning. "
      "candidate: index of the planned view that this one scan was taken from. A list of ScanRecord.\n"
      "The session's options of reading, which keywords change for these scans alone:\n\n" +
      options_text(option_fields(reading));
  py::class_<OpenSession>(module, "Session", help.c_str())
      .def(py::init<const std::filesystem::path&>(), py::arg("folder"), Release(), "Opens a session.")
      .def_static("new", &new_session, py::arg("folder"), new_help.c_str())
      .def("add", &add_scan, py::arg("scan"), py::arg("believed"), py::arg("name") = "",
           py::arg("candidate") = py::none(), py::arg("commanded") = py::none(), Release(),
           "Adds a Scan from where the robot believes the sensor to be (4x4, world from sensor, metres): it is stored, "
           "then registered and merged where that succeeds. candidate: index of the planned view that it was taken "
           "from; commanded: where the sensor was sent (4x4), by default that view. Returns its ScanRecord once it is "
           "safe on disk.")
      .def("add_depth", &add_depth, py::arg("depth"), py::arg("intrinsics"), py::arg("pose"),
           py::arg("distortion") = std::vector<double>(), py::arg("mask") = py::none(), py::arg("name") = "",
           py::arg("candidate") = py::none(),
           "Adds a depth image as scan_from_depth() reads it, by the session's options (depth_scale, unit, hand_eye, "
           "crop, ...): depth (rows, columns), uint16 or floating-point; intrinsics (3, 3); pose (4, 4) as the robot "
           "reports it; mask (rows, columns), zero where a pixel does not count. Returns its ScanRecord once it is "
           "safe on "
           "disk.")
      .def("add_files", &add_files, py::arg("path"), py::arg("candidate") = py::none(), files_help.c_str())
      .def(
          "next", [](const OpenSession& session) { return next(session).plan; },
          "The Plan for the next scan, its views in rank with their factors and what fell out with the reason; None "
          "where there is none, why_finished then says so. Does not wait for a registration in another thread.")
      .def_property_readonly(
          "why_finished", [](const OpenSession& session) { return next(session).why_finished; },
          "Why next() gives none; empty where it gives one.")
      .def(
          "skip",
          [](const OpenSession& session, int candidate, const std::string& reason) {
            session.get()->skip(candidate, reason);
          },
          py::arg("candidate"), py::arg("reason"), Release(),
          "This candidate is not planned again: it could not be reached, or nobody wants it.")
      .def(
          "unskip", [](const OpenSession& session, int candidate) { session.get()->unskip(candidate); },
          py::arg("candidate"), Release(), "Takes skip() back.")
      .def(
          "remove", [](const OpenSession& session, int number) { session.get()->remove(number); }, py::arg("number"),
          Release(),
          "Takes a scan out, as if it had never come: those after it are registered again. Its file is kept.")
      .def(
          "restore", [](const OpenSession& session, int number) { session.get()->restore(number); }, py::arg("number"),
          Release(), "Takes remove() back.")
      .def(
          "status", [](const OpenSession& session) { return session.get()->status(); }, "How it stands: SessionStatus.")
      .def_property_readonly(
          "map", [](const OpenSession& session) { return session.get()->status().state->map; },
          "The VoxelMap after the last integrated scan; a copy.")
      .def_property_readonly(
          "scans", [](const OpenSession& session) { return session.get()->status().state->scans; },
          "List of ScanRecord, in the order of the scans.")
      .def_property_readonly(
          "current", [](const OpenSession& session) { return session.get()->status().state->current; },
          "(4, 4), where the last scan was taken.")
      .def(
          "cloud", [](const OpenSession& session) { return session.get()->cloud(); }, Release(),
          "The fused PointCloud in the box, world frame; a copy.")
      .def(
          "finish",
          [](const OpenSession& session, bool conclude) {
            session.get()->finish(report_page, ForeignFiles::refuse,
                                  conclude ? Session::Ending::concluded : Session::Ending::as_it_stands);
          },
          py::arg("conclude") = false, Release(),
          "Writes map.nrrd, map.ply, model.ply, mesh.ply, views.csv, summary.json and report.html into the folder. "
          "conclude: refused scans are tried again and all poses improved together before. Scans may be added "
          "afterwards.")
      .def_property_readonly(
          "folder", [](const OpenSession& session) { return session.get()->folder(); }, "Path of the session.")
      .def_property_readonly("is_open", &OpenSession::is_open, "False after close().")
      .def("close", &OpenSession::close, "Lets others open the session; this one can no longer be used.")
      .def("__enter__", [](OpenSession& session) -> OpenSession& { return session; })
      .def("__exit__", [](OpenSession& session, const py::args&) { session.close(); })
      .def("__repr__", [](const OpenSession& session) {
        if (!session.is_open()) return std::string("<vantage.Session, closed>");
        return concat("<vantage.Session ", session.get()->folder().string(), ", ", session.get()->status().stored,
                      " scans>");
      });
}

}  // namespace vantage::python
