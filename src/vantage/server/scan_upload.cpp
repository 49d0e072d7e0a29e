#include "vantage/server/scan_upload.hpp"

#include <algorithm>
#include <array>

#include "vantage/core/error.hpp"
#include "vantage/core/number_text.hpp"
#include "vantage/files/plain_text.hpp"
#include "vantage/formats/png16.hpp"
#include "vantage/formats/pose_file.hpp"
#include "vantage/recordings/scan_bytes.hpp"
#include "vantage/server/multipart.hpp"

namespace vantage {
namespace {

constexpr std::size_t longest_name = 200;
constexpr std::size_t longest_pose = std::size_t{4} * 1024;
constexpr std::size_t longest_intrinsics = std::size_t{16} * 1024;

const FormPart* find(const std::vector<FormPart>& parts, std::string_view name) {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const FormPart& part) { return part.name == name; });
  return found == parts.end() ? nullptr : &*found;
}

/// Before anybody parses it.
void require_short(const FormPart& part, std::size_t longest) {
  require(part.body.size() <= longest, "field '", part.name, "': has ", part.body.size(), " bytes; must have at most ",
          longest);
}

bool is_json(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

Intrinsics intrinsics_of(const FormPart& part) {
  require_short(part, longest_intrinsics);
  const std::string_view text = part.body;
  if (is_json(text)) return parse_intrinsics_json(text, "intrinsics");
  if (text.find(':') != std::string_view::npos) return parse_intrinsics_yaml(text, "intrinsics");
  return parse_intrinsics_text(text, "intrinsics");
}

int whole_number(std::string_view text, const std::string& what) {
  const std::optional<int> value = number_from<int>(text);
  require(value.has_value(), what, ": must be a whole number");
  return value.value_or(0);
}

void require_known(const std::vector<FormPart>& parts) {
  constexpr std::array known{"depth", "cloud", "mask", "pose", "commanded", "intrinsics", "name", "candidate", "key"};
  for (const FormPart& part : parts) {
    require(std::find(known.begin(), known.end(), part.name) != known.end(), "field '", part.name,
            "': is not known; must be depth, cloud, mask, pose, commanded, intrinsics, name, candidate or key");
  }
}

/// The pose in a field, of the hand where there is one, as one of the sensor.
Pose pose_of(const FormPart& part, const UploadOptions& upload) {
  require_short(part, longest_pose);
  const Pose hand = is_json(part.body) ? parse_pose_json(part.body, part.name) : parse_pose_text(part.body, part.name);
  return sensor_pose(hand, upload.hand_eye, upload.reading);
}

/// Empty where the field is missing.
std::string text_of(const std::vector<FormPart>& parts, std::string_view field) {
  const FormPart* part = find(parts, field);
  if (part == nullptr) return {};
  require_short(*part, longest_name);
  require_plain_text(part->body, concat("field '", field, "'"));
  return std::string(part->body);
}

Scan depth_scan(const FormPart& depth, const std::vector<FormPart>& parts, const UploadOptions& upload) {
  const FormPart *intrinsics = find(parts, "intrinsics"), *mask = find(parts, "mask");
  require(intrinsics != nullptr || upload.intrinsics,
          "the field 'intrinsics' is missing: 3x3 numbers, ROS camera_info or Open3D");
  const Intrinsics used = intrinsics != nullptr ? intrinsics_of(*intrinsics) : *upload.intrinsics;
  const DepthPixels pixels = decode_depth(depth.body, used.resolution, "depth", upload.most_pixels);
  const Resolution size = std::visit([](const auto& image) { return image.resolution; }, pixels);
  std::optional<Mask> counts;
  if (mask != nullptr) counts = decode_png_mask(mask->body, size, "mask");
  return scan_of_depth(pixels, used, counts, upload.reading);
}

}  // namespace

UploadOptions upload_options(const ScanFolderOptions& reading) {
  UploadOptions options{reading, hand_eye_offset(reading), std::nullopt};
  if (!reading.intrinsics.empty() && std::filesystem::exists(reading.intrinsics))
    options.intrinsics = read_intrinsics(reading.intrinsics);
  return options;
}

SessionScan parse_scan_upload(std::string_view body, std::string_view boundary, const UploadOptions& upload) {
  const ScanFolderOptions& options = upload.reading;
  const std::vector<FormPart> parts = parse_multipart(body, boundary);
  require_known(parts);
  const FormPart *depth = find(parts, "depth"), *cloud = find(parts, "cloud"), *pose = find(parts, "pose");
  require((depth == nullptr) != (cloud == nullptr), "a scan must have either the field 'depth' or the field 'cloud'");
  require(pose != nullptr, "the field 'pose' is missing: 4x4 numbers, or JSON with position and orientation");
  require(depth != nullptr || find(parts, "mask") == nullptr, "field 'mask': goes with 'depth', not with 'cloud'");
  SessionScan scan;
  Pose world_from_sensor = pose_of(*pose, upload);
  if (depth != nullptr) {
    scan.scan = depth_scan(*depth, parts, upload);
  } else {
    const CloudFile file = parse_cloud(cloud->body, cloud_format(cloud->file_name), "cloud", upload.most_values);
    if (options.cloud_frame == "sensor") {
      Pose cloud_from_sensor = file.cloud_from_sensor;
      cloud_from_sensor.translation() *= options.metres_per_unit();
      world_from_sensor = world_from_sensor * cloud_from_sensor;
    }
    scan.scan = scan_of_cloud(file, world_from_sensor, options);
  }
  scan.believed.world_from_sensor = world_from_sensor;
  scan.scan = cropped(std::move(scan.scan), scan.believed, options);
  scan.name = text_of(parts, "name");
  scan.key = text_of(parts, "key");
  if (const FormPart* candidate = find(parts, "candidate")) scan.candidate = whole_number(candidate->body, "candidate");
  if (const FormPart* commanded = find(parts, "commanded"))
    scan.commanded.emplace().world_from_sensor = pose_of(*commanded, upload);
  return scan;
}

}  // namespace vantage
