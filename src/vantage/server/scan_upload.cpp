#include "vantage/server/scan_upload.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "vantage/core/error.hpp"
#include "vantage/io/pose_file.hpp"
#include "vantage/io/scan_bytes.hpp"
#include "vantage/server/multipart.hpp"

namespace vantage {
namespace {

constexpr std::size_t longest_name = 200;

const FormPart* find(const std::vector<FormPart>& parts, std::string_view name) {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const FormPart& part) { return part.name == name; });
  return found == parts.end() ? nullptr : &*found;
}

bool is_json(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

Intrinsics intrinsics_of(std::string_view text) {
  if (is_json(text)) return parse_intrinsics_json(text, "intrinsics");
  if (text.find(':') != std::string_view::npos) return parse_intrinsics_yaml(text, "intrinsics");
  return parse_intrinsics_text(text, "intrinsics");
}

int whole_number(std::string_view text, const std::string& what) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error == std::errc() && end == text.data() + text.size(), what, ": must be a whole number");
  return value;
}

void require_known(const std::vector<FormPart>& parts) {
  constexpr std::array known{"depth", "cloud", "pose", "intrinsics", "name", "candidate"};
  for (const FormPart& part : parts) {
    require(std::find(known.begin(), known.end(), part.name) != known.end(), "field '", part.name,
            "': is not known; must be depth, cloud, pose, intrinsics, name or candidate");
  }
}

}  // namespace

UploadOptions upload_options(const ScanFolderOptions& reading) {
  UploadOptions options{reading, hand_eye_offset(reading), std::nullopt};
  if (!reading.intrinsics.empty() && std::filesystem::exists(reading.intrinsics))
    options.intrinsics = read_intrinsics(reading.intrinsics);
  return options;
}

SessionScan parse_scan_upload(std::string_view body, const UploadOptions& upload) {
  const ScanFolderOptions& options = upload.reading;
  const std::vector<FormPart> parts = parse_multipart(body);
  require_known(parts);
  const FormPart *depth = find(parts, "depth"), *cloud = find(parts, "cloud"), *pose = find(parts, "pose");
  require((depth == nullptr) != (cloud == nullptr), "a scan must have either the field 'depth' or the field 'cloud'");
  require(pose != nullptr, "the field 'pose' is missing: 4x4 numbers, or JSON with position and orientation");
  SessionScan scan;
  const Pose hand = is_json(pose->body) ? parse_pose_json(pose->body, "pose") : parse_pose_text(pose->body, "pose");
  Pose world_from_sensor = sensor_pose(hand, upload.hand_eye, options);
  if (depth != nullptr) {
    const FormPart* intrinsics = find(parts, "intrinsics");
    require(intrinsics != nullptr || upload.intrinsics,
            "the field 'intrinsics' is missing: 3x3 numbers, ROS camera_info or Open3D");
    scan.scan = scan_of_depth(depth->body, intrinsics != nullptr ? intrinsics_of(intrinsics->body) : *upload.intrinsics,
                              options, "depth");
  } else {
    const CloudFile file = parse_cloud(cloud->body, cloud_format(cloud->file_name), "cloud");
    if (options.cloud_frame == "sensor") {
      Pose cloud_from_sensor = file.cloud_from_sensor;
      cloud_from_sensor.translation() *= options.metres_per_unit();
      world_from_sensor = world_from_sensor * cloud_from_sensor;
    }
    scan.scan = scan_of_cloud(file, world_from_sensor, options);
  }
  scan.believed.world_from_sensor = world_from_sensor;
  scan.scan = cropped(std::move(scan.scan), scan.believed, options);
  if (const FormPart* name = find(parts, "name")) {
    require(name->body.size() <= longest_name, "field 'name': has ", name->body.size(), " bytes; must have at most ",
            longest_name);
    scan.name = name->body;
  }
  if (const FormPart* candidate = find(parts, "candidate")) scan.candidate = whole_number(candidate->body, "candidate");
  return scan;
}

}  // namespace vantage
