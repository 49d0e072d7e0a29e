#pragma once

#include "arrays.hpp"
#include "vantage/map/scan.hpp"

namespace vantage::python {

/// pybind11 would take a variant apart; this keeps it whole.
struct ScanHolder {
  Scan scan;
};

// Each adds a part of the interface to the module; see the file of that name. The order is that of the dependencies.
void bind_errors(py::module_& module);
void bind_sensor(py::module_& module);
void bind_map(py::module_& module);
void bind_scans(py::module_& module);
void bind_utility(py::module_& module);
void bind_planning(py::module_& module);
void bind_registration(py::module_& module);
void bind_simulation(py::module_& module);
void bind_files(py::module_& module);
void bind_scan_model(py::module_& module);
void bind_depth_input(py::module_& module);
void bind_session(py::module_& module);

}  // namespace vantage::python
