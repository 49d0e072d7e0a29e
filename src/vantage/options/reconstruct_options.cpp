#include "vantage/options/reconstruct_options.hpp"

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/text.hpp"

namespace vantage {
namespace {

std::vector<Box3> boxes_from_text(const std::string& option, const std::string& text) {
  std::vector<Box3> boxes;
  for (const std::string& part : split(text, ';')) {
    if (part.empty()) continue;
    const std::vector<double> n = numbers_from_text(option, part, 6);
    const Vec3 center(n[0], n[1], n[2]);
    const Vec3 half = 0.5 * Vec3(n[3], n[4], n[5]);
    require((half.array() > 0).all(), option, ": '", part, "': the sizes must be positive");
    boxes.emplace_back(center - half, center + half);
  }
  return boxes;
}

}  // namespace

Resolution resolution_from_text(const std::string& option, const std::string& text) {
  const std::vector<std::string> parts = split(text, 'x');
  require(parts.size() == 2, option, ": '", text, "' must be COLUMNSxROWS, for example 320x240");
  Resolution resolution;
  for (std::size_t i = 0; i < 2; ++i) {
    const double value = number_from_text(option, parts[i]);
    require(value >= 1 && value <= 16384 && value == std::floor(value), option, ": '", parts[i],
            "' must be a whole number in 1..16384");
    (i == 0 ? resolution.columns : resolution.rows) = static_cast<int>(value);
  }
  return resolution;
}

RangeCamera camera_from_text(const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  const std::vector<std::string> apertures = split(parts[0], 'x');
  require(parts.size() == 2 && apertures.size() == 2, "camera: '", text,
          "' must be HxV:COLUMNSxROWS with apertures in degrees, for example 45x45:320x320");
  return camera_from_apertures(radians(number_from_text("camera", apertures[0])),
                               radians(number_from_text("camera", apertures[1])),
                               resolution_from_text("camera", parts[1]));
}

RayChoice rays_from_text(const std::string& text) {
  if (text == "sensor") return {RayChoice::Kind::sensor, {}};
  if (text == "ideal") return {RayChoice::Kind::ideal, {}};
  return {RayChoice::Kind::fixed, resolution_from_text("rays", text)};
}

std::string names_of_utilities() {
  std::string list;
  for (const std::string& name : utility_names()) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::vector<std::string> planning_option_names() {
  return {"camera",
          "depth-range",
          "max-incidence",
          "candidates",
          "body-radius",
          "workspace",
          "obstacles",
          "robot",
          "package",
          "travel",
          "search",
          "rays",
          "multi-resolution-b",
          "multi-resolution-stages",
          "multi-resolution-columns",
          "utility",
          "plan",
          "scan-time",
          "speed",
          "alpha-oc",
          "alpha-op",
          "rho",
          "navigation",
          "stop-occplane",
          "deadline"};
}

void ReconstructOptions::validate() const {
  require(!size || (*size > 0 && std::isfinite(*size)), "size = ", size.value_or(0), " m: must be positive");
  depth_noise.validate();
  require(!mixed_pixels || (*mixed_pixels >= 0 && *mixed_pixels <= 1), "mixed-pixels = ", mixed_pixels.value_or(0),
          ": must be a share from 0 to 1");
  sensor_model().validate();
  require_one_of("quality", quality, {"axis", "ray"});
  require_one_of("registration", registration, {"truth", "none", "icp"});
  validate_errors(center);
  require(!learns_error() || registration != "none",
          "believed-error = learn: needs registered poses to learn from; registration must be truth or icp, is none");
  require(initial_view >= 0, "initial-view = ", initial_view, ": must not be negative");
  scene_options().validate();
  range_camera().validate();
  planner_options().validate();
  budget().validate();
}

SceneOptions ReconstructOptions::scene_options() const { return {center, voxel, scene, enclosure, map}; }

RangeCamera ReconstructOptions::range_camera() const {
  RangeCamera result = camera_from_text(camera);
  result.min_depth = depth_range[0];
  result.max_depth = depth_range[1];
  if (max_incidence) result.max_incidence = radians(*max_incidence);
  result.validate();
  return result;
}

SensorModel ReconstructOptions::sensor_model() const {
  SensorModel result = sensor_by_name(sensor);
  if (!depth_noise.is_none()) result = with_noise(result, depth_noise);
  if (mixed_pixels) result.mixed = *mixed_pixels;
  return result;
}

PlannerOptions ReconstructOptions::planner_options() const {
  PlannerOptions result;
  require_one_of("search", search, {"exhaustive", "multi-resolution"});
  result.search = search == "exhaustive" ? SearchKind::exhaustive : SearchKind::multi_resolution;
  result.rays = rays_from_text(rays);
  result.multi_resolution = {multi_resolution_b, multi_resolution_stages, multi_resolution_columns};
  require_one_of("plan", plan, {"view", "tour"});
  require(plan == "view" || utility == "combined" || utility == "tour",
          "plan = tour: chooses by the tour, and utility = ", utility, " by something else; leave one of them out");
  result.utility = plan == "tour" ? "tour" : utility;
  result.tour.time = {scan_time, speed};
  result.seed = seed;
  result.factors = {alpha_oc, alpha_op, rho, navigation};
  result.reach = reach_options();
  result.robot = robot_model;
  if (travel) {
    require_one_of("travel", *travel, {"orthodromic", "straight", "path"});
    result.travel = *travel == "path"       ? TravelKind::path
                    : *travel == "straight" ? TravelKind::straight
                                            : TravelKind::orthodromic;
  }
  if (convolve != "off") {
    result.believed_error = believed_error_model(center);
    result.error_method = convolve == "samples" ? ErrorMethod::samples : ErrorMethod::convolution;
    result.convolution.normalise = convolve == "normalised";
  }
  result.expectation = {error_candidates, error_samples, least_overlap};
  if (registration == "icp" && registrable > 0) {
    result.registrability.emplace();
    result.registrability->error = believed_error_model(center);
    result.registrability->sensor = sensor_model();
    result.registrability->least_probability = registrable;
    result.registrability->least_overlap = least_overlap;
  }
  result.stop_occplane = stop_occplane;
  result.deadline = deadline;
  return result;
}

ReachOptions ReconstructOptions::reach_options() const {
  ReachOptions result;
  result.body_radius = body_radius;
  if (workspace) {
    const std::vector<double> n = numbers_from_text("workspace", *workspace, 6);
    result.workspace = Box3(Vec3(n[0], n[1], n[2]), Vec3(n[3], n[4], n[5]));
  }
  if (obstacles) result.obstacles = boxes_from_text("obstacles", *obstacles);
  return result;
}

std::string ReconstructOptions::travel_unit() const {
  return travel == "path" && robot_model ? robot_model->cost_unit() : "m";
}

Budget ReconstructOptions::budget() const {
  Budget result;
  result.max_views = max_views;
  if (max_distance) result.max_distance = *max_distance;
  if (max_time) result.max_time = *max_time;
  return result;
}

QualityReference ReconstructOptions::quality_reference() const {
  return quality == "ray" ? QualityReference::ray : QualityReference::axis;
}

Candidates ReconstructOptions::candidate_views() const { return candidates_from_text(candidates, center); }

}  // namespace vantage
