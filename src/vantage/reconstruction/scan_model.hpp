#pragma once

#include <memory>
#include <string>

#include "vantage/reconstruction/from_scans.hpp"

namespace vantage {

/// Finds the poses of real scans: ICP with what noisy frames and good robots ask for, or the poses as they are.
[[nodiscard]] std::unique_ptr<Registrar> make_registrar(const ScanPlanOptions& options, const ScanScene& scene);

/// What real scans, merged one after the other, come to.
class ScanModel {
 public:
  explicit ScanModel(const ScanScene& scene);

  /// Registers the scan, merges it where that succeeds, and notes it. `name` becomes the reason in its record.
  const ScanRecord& add(const std::string& name, const Scan& scan, const View& believed, Registrar& registrar);

  [[nodiscard]] const ObjectModel& model() const { return model_; }
  /// Where the sensor is: at its last scan, in the middle of its sight lines' origins.
  [[nodiscard]] const View& current() const { return current_; }

 private:
  ObjectModel model_;
  View current_;
};

}  // namespace vantage
