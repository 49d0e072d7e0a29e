#include "vantage/model/scan_cleaner.hpp"

#include "vantage/sensor/flying_pixels.hpp"

namespace vantage {

void SensorOptions::validate() const {
  if (const auto model = given()) model->validate();
}

std::optional<SensorModel> SensorOptions::given() const {
  if (!sensor && !depth_noise) return std::nullopt;
  SensorModel model = sensor ? sensor_by_name(*sensor) : SensorModel();
  if (depth_noise) {
    depth_noise->validate();
    model = with_noise(model, *depth_noise);
  }
  return model;
}

ScanCleaner::Result ScanCleaner::clean(const Scan& scan) {
  const auto* const image = std::get_if<ImageScan>(&scan);
  if (image == nullptr) return {};
  if (!is_given_) {
    estimator_.add(image->image);
    sensor_ = estimator_.estimate();
  }
  if (!sensor_ || rule_ == FlyingPixelRule::keep) return {};
  CleanImage cleaned = without_flying_pixels(image->image, *sensor_);
  if (cleaned.flying == 0) return {};
  return {scan_of(std::move(cleaned.image)), cleaned.flying};
}

}  // namespace vantage
