#include "vantage/sensor/sensor_model.hpp"

#include <array>
#include <numbers>
#include <utility>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr double largest_error = 1e6;  // metres, as for the scene

constexpr double right_angle = std::numbers::pi / 2;

/// Nguyen, Izadi and Lovell (3DIMPVT 2012): 1.2 mm + 1.9 mm/m^2 (z - 0.4 m)^2, growing as 0.1 mm t^2/(90 deg - t)^2
/// with the incidence (tan^2 t is within a third of that up to 60 degrees); lateral 0.8 pixels. Khoshelham and Elberink
/// (Sensors 2012): steps of 2.85 mm/m^2 z^2, 7 cm at 5 m.
SensorModel primesense() {
  SensorModel sensor;
  sensor.constant = 0.0012 + 0.0019 * 0.4 * 0.4;
  sensor.linear = -2 * 0.0019 * 0.4;
  sensor.quadratic = 0.0019;
  sensor.incidence = 0.0001;
  sensor.quantum = 0.001;
  sensor.disparity_quantum = 0.00285;
  sensor.lateral = 0.8;
  sensor.mixed = 0.1;
  sensor.dropout_from_incidence = radians(60);
  return sensor;
}

/// Intel's tuning guide for the D400 series: RMS = z^2 subpixel/(focal length baseline) with 0.08 pixels; disparities
/// in steps of 1/32 pixel; 848 columns over 90 degrees, baseline 50 mm.
SensorModel realsense_d435() {
  constexpr double pixels_times_metres = 424 * 0.05;
  SensorModel sensor;
  sensor.quadratic = 0.08 / pixels_times_metres;
  sensor.quantum = 0.001;
  sensor.disparity_quantum = 1.0 / 32 / pixels_times_metres;
  sensor.lateral = 1;
  sensor.mixed = 0.5;
  sensor.dropout_from_incidence = radians(70);
  return sensor;
}

/// Intel's data sheet of the L515: 2.5 mm at 1 m, 15.5 mm at 9 m; depths in steps of 0.25 mm.
SensorModel realsense_l515() {
  SensorModel sensor;
  sensor.linear = (0.0155 - 0.0025) / (9 - 1);
  sensor.constant = 0.0025 - sensor.linear;
  sensor.quantum = 0.00025;
  sensor.lateral = 0.5;
  sensor.mixed = 0.3;
  sensor.dropout_from_incidence = radians(70);
  return sensor;
}

/// About 1 mm at 1 m and 3 mm at 3 m, in the order of what Toelgyessy et al. (Sensors 2021) measured and far below the
/// 17 mm that Microsoft's specification allows at the end of the range; depths in millimetres.
SensorModel azure_kinect() {
  SensorModel sensor;
  sensor.linear = 0.001;
  sensor.quantum = 0.001;
  sensor.lateral = 0.25;
  sensor.mixed = 0.5;
  sensor.dropout_from_incidence = radians(70);
  return sensor;
}

/// Fringe projection as in industrial scanners: 0.1 mm at 0.65 m, as triangulation growing with z^2.
SensorModel structured_light() {
  SensorModel sensor;
  sensor.quadratic = 0.0001 / (0.65 * 0.65);
  sensor.lateral = 0.3;
  sensor.mixed = 0.05;
  sensor.dropout_from_incidence = radians(70);
  return sensor;
}

SensorModel ideal() { return {}; }

constexpr std::array<std::pair<const char*, SensorModel (*)()>, 6> presets{{
    {"ideal", ideal},
    {"primesense", primesense},
    {"realsense-d435", realsense_d435},
    {"realsense-l515", realsense_l515},
    {"azure-kinect", azure_kinect},
    {"structured-light", structured_light},
}};

/// The value in thousandths with three significant digits: metres as millimetres.
std::string thousandths(double value) {
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // a stream by itself cuts the text off where memory is short
  text.precision(3);
  text << 1000 * value;
  return text.str();
}

}  // namespace

double SensorModel::quantised(double depth) const {
  double told = depth;
  if (disparity_quantum > 0) told = 1 / (std::round(1 / (told * disparity_quantum)) * disparity_quantum);
  if (quantum > 0) told = std::round(told / quantum) * quantum;
  return told;
}

double SensorModel::dropout_at(double angle) const {
  if (!dropout_from_incidence) return dropout;
  const double share = (angle - *dropout_from_incidence) / (right_angle - *dropout_from_incidence);
  return 1 - (1 - dropout) * (1 - std::clamp(share, 0.0, 1.0));
}

bool SensorModel::is_ideal() const { return *this == SensorModel{}; }

void SensorModel::validate() const {
  const auto not_negative = [](double value, const char* field, const char* unit) {
    require(value >= 0 && value <= largest_error, "sensor: ", field, " = ", value, unit, ": must be from 0 to ",
            largest_error);
  };
  const auto share = [](double value, const char* field) {
    require(value >= 0 && value <= 1, "sensor: ", field, " = ", value, ": must be a share from 0 to 1");
  };
  not_negative(constant, "constant", " m");
  not_negative(quadratic, "quadratic", " 1/m");
  not_negative(incidence, "incidence", " m");
  not_negative(quantum, "quantum", " m");
  not_negative(disparity_quantum, "disparity_quantum", " 1/m");
  not_negative(lateral, "lateral", " pixels");
  // The parabola must not dip below zero: its discriminant is negative where it has a lowest point at positive depth.
  require(std::isfinite(linear) && (linear >= 0 || linear * linear <= 4 * constant * quadratic),
          "sensor: linear = ", linear, ": makes the deviation negative at some depth");
  share(mixed, "mixed");
  share(dropout, "dropout");
  if (dropout_from_incidence) {
    require(*dropout_from_incidence >= 0 && *dropout_from_incidence < right_angle,
            "sensor: dropout_from_incidence = ", degrees(*dropout_from_incidence),
            " degrees: must be at least 0 and less than 90");
  }
}

void DepthDeviation::validate() const {
  for (const double part : {a, b, c}) {
    require(part >= 0 && part <= largest_error, "depth-noise = ", a, ",", b, ",", c, ": must be from 0 to ",
            largest_error);
  }
}

SensorModel with_noise(SensorModel sensor, const DepthDeviation& noise) {
  sensor.constant = noise.a;
  sensor.linear = 0;
  sensor.quadratic = noise.b;
  sensor.incidence = noise.c;
  return sensor;
}

SensorModel sensor_with(const DepthDeviation& noise) { return with_noise({}, noise); }

std::vector<std::string> sensor_names() {
  std::vector<std::string> names;
  names.reserve(std::size(presets));
  for (const auto& [name, make] : presets) names.emplace_back(name);
  return names;
}

std::string names_of_sensors() {
  std::string list;
  for (const auto& [name, make] : presets) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

SensorModel sensor_by_name(std::string_view name) {
  for (const auto& [preset, make] : presets) {
    if (name == preset) return make();
  }
  throw InputError(concat("sensor = '", name, "': must be one of: ", names_of_sensors()));
}

std::string description(const SensorModel& sensor) {
  std::string text = thousandths(sensor.constant) + " mm";
  const auto add = [&](double factor, const char* rest) {
    if (factor != 0) text += (factor < 0 ? " - " : " + ") + thousandths(std::abs(factor)) + rest;
  };
  add(sensor.linear, " mm/m z");
  add(sensor.quadratic, " mm/m2 z2");
  add(sensor.incidence, " mm tan2(incidence)");
  return text;
}

}  // namespace vantage
