#include "bindings.hpp"

PYBIND11_MODULE(_vantage, module) {
  using namespace vantage::python;
  module.doc() = "The compiled part of vantage: what the C++ library offers, numpy in and out.";
  module.attr("__version__") = VANTAGE_VERSION;
  bind_errors(module);
  bind_sensor(module);
  bind_map(module);
  bind_scans(module);
  bind_utility(module);
  bind_planning(module);
  bind_registration(module);
  bind_simulation(module);
  bind_files(module);
  bind_scan_model(module);
  bind_depth_input(module);
  bind_session(module);
}
