#include "readers.hpp"
#include "vantage/io/robot_file.hpp"
#include "vantage/io/scan_planning_options.hpp"

namespace vantage::fuzz {
namespace {

/// Options of a whole run and of real scans, from the file to the check of every value.
void read_options(std::string_view bytes) {
  ReconstructOptions run;
  set_options_from_yaml(option_fields(run), bytes, "input");
  run.validate();
}
void read_scan_options(std::string_view bytes) {
  ScanPlanningOptions options;
  set_options_from_yaml(option_fields(options), bytes, "input");
  options.validate();
}

void read_robot(std::string_view bytes) {
  ReconstructOptions options;
  set_robot(options, std::string(bytes), VANTAGE_EXAMPLES "/input.yaml");
}

}  // namespace

const std::vector<Reader>& option_readers() {
  static const std::vector<Reader> all{
      {"options", "options", read_options},
      {"scan_options", "options", read_scan_options},
      {"robot", "robot", read_robot},
  };
  return all;
}

}  // namespace vantage::fuzz
