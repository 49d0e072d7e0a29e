#include "vantage/session/session_scan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/files/json_text.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "scans are stored as they lie in memory");

constexpr std::string_view any_first_word = "vantage-scan-";
constexpr std::string_view first_word = "vantage-scan-1 ";
constexpr double farthest = 1e6;  // metres, as for the scene
constexpr std::size_t most_values = std::size_t{1} << 28U;

bool is_of_newer_format(std::string_view bytes) {
  if (!bytes.starts_with(any_first_word)) return false;
  const std::string_view number = bytes.substr(any_first_word.size(), bytes.find(' ') - any_first_word.size());
  return !number.empty() && number.size() < 4 && number != "1" && number != "0" &&
         number.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_near(const Vec3& point) { return point.cwiseAbs().maxCoeff() <= farthest; }

Json numbers(const double* first, std::size_t count) { return std::vector<double>(first, first + count); }

/// The upper three rows of a pose, column by column.
Json pose_columns(const Pose& pose) {
  const Eigen::Matrix<double, 3, 4> rows = pose.matrix().topRows<3>();
  return numbers(rows.data(), 12);
}

const nlohmann::json& member(const nlohmann::json& object, const char* key, const std::string& name) {
  require(object.is_object() && object.contains(key), name, ": has no '", key, "'");
  return object[key];
}

double number(const nlohmann::json& object, const char* key, const std::string& name) {
  return json_number(member(object, key, name), concat(name, ": ", key));
}

std::size_t count(const nlohmann::json& object, const char* key, const std::string& name) {
  const double value = number(object, key, name);
  require(value >= 0 && value <= most_values && value == std::floor(value), name, ": ", key, " = ", value,
          ": must be a whole number of at most ", most_values);
  return static_cast<std::size_t>(value);
}

std::string text(const nlohmann::json& object, const char* key, const std::string& name) {
  const nlohmann::json& value = member(object, key, name);
  require(value.is_string(), name, ": ", key, " must be text");
  return value.get<std::string>();
}

template <std::size_t Count>
std::array<double, Count> list(const nlohmann::json& object, const char* key, const std::string& name) {
  const nlohmann::json& values = member(object, key, name);
  require(values.is_array() && values.size() == Count, name, ": ", key, " must be ", Count, " numbers");
  std::array<double, Count> result{};
  for (std::size_t i = 0; i < Count; ++i) result[i] = json_number(values[i], concat(name, ": ", key));
  return result;
}

Pose pose(const nlohmann::json& object, const char* key, const std::string& name) {
  const std::array<double, 12> columns = list<12>(object, key, name);
  Pose result = Pose::Identity();
  result.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4>>(columns.data());
  return result;
}

template <class Value>
void append(std::string& bytes, const std::vector<Value>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
}

/// Takes `count` values off the front of the bytes.
template <class Value>
std::vector<Value> take(std::string_view& bytes, std::size_t count, const std::string& name) {
  require(bytes.size() / sizeof(Value) >= count, name, ": is cut off");
  std::vector<Value> values(count);
  if (count > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), count * sizeof(Value));
  bytes.remove_prefix(count * sizeof(Value));
  return values;
}

Json scan_camera_json(const RangeCamera& camera) {
  return {{"columns", camera.resolution.columns},
          {"rows", camera.resolution.rows},
          {"left", camera.left},
          {"right", camera.right},
          {"top", camera.top},
          {"bottom", camera.bottom},
          {"min_depth", camera.min_depth},
          {"max_depth", std::isfinite(camera.max_depth) ? Json(camera.max_depth) : Json(nullptr)},
          {"max_incidence", camera.max_incidence ? Json(*camera.max_incidence) : Json(nullptr)}};
}

RangeCamera parse_camera(const nlohmann::json& json, const std::string& name) {
  RangeCamera camera;
  camera.resolution = {static_cast<int>(count(json, "columns", name)), static_cast<int>(count(json, "rows", name))};
  camera.left = number(json, "left", name);
  camera.right = number(json, "right", name);
  camera.top = number(json, "top", name);
  camera.bottom = number(json, "bottom", name);
  camera.min_depth = number(json, "min_depth", name);
  camera.max_depth = std::numeric_limits<double>::infinity();
  if (!member(json, "max_depth", name).is_null()) camera.max_depth = number(json, "max_depth", name);
  if (!member(json, "max_incidence", name).is_null()) camera.max_incidence = number(json, "max_incidence", name);
  camera.validate();
  return camera;
}

/// `what` is for errors.
void require_pose(const View& view, const std::string& what) {
  require(view.world_from_sensor.matrix().allFinite(), what, " has a number that is not finite");
  require(is_near(view.position()), what, " is ", view.position().norm(), " m from the origin; must be within ",
          farthest, " m");
  (void)rigid_pose(view.world_from_sensor.matrix(), what);
}

/// JSON on one line; bytes that are no UTF-8 are replaced.
std::string line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// A line of JSON that begins with `header`, then the arrays of the scan.
std::string bytes_of(Json header, const Scan& scan) {
  std::string arrays;
  if (const auto* image = std::get_if<ImageScan>(&scan)) {
    header["camera"] = scan_camera_json(image->image.camera);
    append(arrays, image->image.depth);
  } else {
    const auto& points = std::get<PointScan>(scan);
    header["points"] = points.points.size();
    header["normals"] = points.normals.size();
    header["origins"] = points.origins.size();
    header["axis"] = numbers(points.axis.data(), 3);
    append(arrays, points.points);
    append(arrays, points.normals);
    append(arrays, points.origins);
  }
  std::string bytes = concat(first_word, line(header), "\n");
  bytes.append(arrays);
  return bytes;
}

}  // namespace

void SessionScan::validate() const {
  require_pose(believed, concat("scan ", name, ": its pose"));
  if (commanded) require_pose(*commanded, concat("scan ", name, ": the commanded pose"));
  require(!candidate || *candidate >= 0, "scan ", name, ": candidate = ", candidate.value_or(0),
          ": must not be negative");
  if (const auto* image = std::get_if<ImageScan>(&scan)) {
    image->image.validate();
    return;
  }
  const auto& points = std::get<PointScan>(scan);
  const auto finite = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](const auto& value) { return value.allFinite(); });
  };
  require(finite(points.points) && finite(points.normals) && finite(points.origins) && points.axis.allFinite(), "scan ",
          name, ": has a number that is not finite");
  const auto near = [](const std::vector<Vec3>& values) { return std::all_of(values.begin(), values.end(), is_near); };
  require(near(points.points) && near(points.origins), "scan ", name, ": has a coordinate beyond ", farthest, " m");
  require(points.normals.empty() || points.normals.size() == points.points.size(), "scan ", name, ": has ",
          points.normals.size(), " normals for ", points.points.size(), " points");
  require(points.origins.size() == 1 || points.origins.size() == points.points.size(), "scan ", name, ": has ",
          points.origins.size(), " origins for ", points.points.size(), " points; must be one, or one each");
}

std::string scan_bytes(const SessionScan& scan) {
  Json header;
  header["name"] = scan.name;
  header["candidate"] = scan.candidate ? Json(*scan.candidate) : Json(nullptr);
  header["believed"] = pose_columns(scan.believed.world_from_sensor);
  if (!scan.key.empty()) header["key"] = scan.key;
  if (scan.commanded) header["commanded"] = pose_columns(scan.commanded->world_from_sensor);
  return bytes_of(std::move(header), scan.scan);
}

std::string measured_bytes(const SessionScan& scan) {
  return bytes_of({{"believed", pose_columns(scan.believed.world_from_sensor)}}, scan.scan);
}

SessionScan parse_scan(std::string_view bytes, const std::string& name) {
  const std::size_t end = bytes.find('\n');
  if (is_of_newer_format(bytes)) throw NewerFormat(concat(name, ": was written by a newer version of the program"));
  require(bytes.starts_with(first_word) && end != std::string_view::npos, name, ": is no scan of a session");
  const nlohmann::json header = parse_json(bytes.substr(first_word.size(), end - first_word.size()), name);
  bytes.remove_prefix(end + 1);
  SessionScan scan;
  scan.name = text(header, "name", name);
  if (!member(header, "candidate", name).is_null()) scan.candidate = static_cast<int>(count(header, "candidate", name));
  scan.believed.world_from_sensor = pose(header, "believed", name);
  if (header.contains("key")) scan.key = text(header, "key", name);
  if (header.contains("commanded")) scan.commanded.emplace().world_from_sensor = pose(header, "commanded", name);
  if (header.contains("camera")) {
    RangeImage image{parse_camera(header["camera"], name), {}};
    image.depth = take<float>(bytes, static_cast<std::size_t>(image.camera.resolution.rays()), name);
    scan.scan = scan_of(std::move(image));
  } else {
    PointScan points;
    points.points = take<Vec3>(bytes, count(header, "points", name), name);
    points.normals = take<Vec3f>(bytes, count(header, "normals", name), name);
    points.origins = take<Vec3>(bytes, count(header, "origins", name), name);
    const std::array<double, 3> axis = list<3>(header, "axis", name);
    points.axis = Vec3(axis[0], axis[1], axis[2]);
    scan.scan = std::move(points);
  }
  require(bytes.empty(), name, ": has ", bytes.size(), " bytes too many");
  scan.validate();
  return scan;
}

std::string located_text(const Located& located, const std::string& scan_checksum) {
  Json json;
  json["scan_crc32"] = scan_checksum;
  json["registered"] = pose_columns(located.view.world_from_sensor);
  json["accepted"] = located.accepted;
  json["overlap"] = located.overlap;
  json["residual"] = located.residual;
  json["verdict"] = located.verdict;
  json["detail"] = located.detail;
  return line(json);
}

StoredLocated parse_located(std::string_view bytes, const std::string& name) {
  const nlohmann::json json = parse_json(bytes, name);
  StoredLocated stored{{}, text(json, "scan_crc32", name)};
  Located& located = stored.located;
  located.view.world_from_sensor = pose(json, "registered", name);
  const nlohmann::json& accepted = member(json, "accepted", name);
  require(accepted.is_boolean(), name, ": accepted must be true or false");
  located.accepted = accepted.get<bool>();
  located.overlap = number(json, "overlap", name);
  located.residual = number(json, "residual", name);
  located.verdict = text(json, "verdict", name);
  located.detail = text(json, "detail", name);
  return stored;
}

}  // namespace vantage
