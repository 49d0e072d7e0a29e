#pragma once

#include <optional>

#include "vantage/map/scan.hpp"
#include "vantage/model/sensor_options.hpp"
#include "vantage/sensor/sensor_estimator.hpp"

namespace vantage {

/// Learns from scan after scan how their sensor errs, unless that is given, and takes out the flying pixels.
class ScanCleaner {
 public:
  explicit ScanCleaner(const SensorOptions& options) : rule_(options.flying_pixels), sensor_(options.given()) {
    is_given_ = sensor_.has_value();
  }

  struct Result {
    std::optional<Scan> scan;  // nothing where the scan stays as it is
    std::int64_t flying = 0;   // pixels that became unknown
  };
  /// Line scanners and clouds stay as they are: their points have no neighbours that are known.
  [[nodiscard]] Result clean(const Scan& scan);

  /// How the sensor errs by the options and the scans so far; nothing where neither says.
  [[nodiscard]] const std::optional<SensorModel>& sensor() const { return sensor_; }
  [[nodiscard]] bool is_given() const { return is_given_; }

 private:
  FlyingPixelRule rule_;
  std::optional<SensorModel> sensor_;
  bool is_given_ = false;
  SensorEstimator estimator_;
};

}  // namespace vantage
