#include <nlohmann/json.hpp>

#include "readers.hpp"
#include "vantage/options/robot_file.hpp"
#include "vantage/options/scan_planning_options.hpp"
#include "vantage/server/multipart.hpp"
#include "vantage/server/scan_upload.hpp"
#include "vantage/server/session_request.hpp"

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

/// A body that brings its own intrinsics, for a session with options that change what is read.
void read_upload(std::string_view bytes) {
  ScanFolderOptions reading;
  reading.unit = "mm";
  reading.hand_eye = "0,0,50,0,0,0,1";
  reading.crop = Eigen::Matrix<double, 6, 1>{{0, 0, 1, 2, 2, 2}};
  (void)parse_scan_upload(bytes, "B", upload_options(reading));
}

void read_json_body(std::string_view bytes) {
  HttpRequest request;
  request.body = std::string(bytes);
  const nlohmann::json body = body_object(request, {"candidate", "reason"});
  (void)body_candidate(body, 80);
  (void)body_text(body, "reason");
}

}  // namespace

const std::vector<Reader>& option_readers() {
  static const std::vector<Reader> all{
      {"options", "options", read_options},
      {"scan_options", "options", read_scan_options},
      {"robot", "robot", read_robot},
      {"multipart", "http", [](std::string_view bytes) { (void)parse_multipart(bytes, "B"); }},
      {"scan_upload", "http", read_upload},
      {"json_body", "http", read_json_body},
  };
  return all;
}

}  // namespace vantage::fuzz
