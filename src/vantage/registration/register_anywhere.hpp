#pragma once

#include <vector>

#include "vantage/registration/registration.hpp"

namespace vantage {

/// How a scan is registered of whose pose nothing is known.
struct AnywhereOptions {
  RegistrationOptions registration;
  std::size_t coarse_poses = 128;  // on which features agree, tried with few samples
  std::size_t fine_poses = 6;      // of them, tried with all samples
  double suggested_within =
      0.03;                    // metres by which suggested poses put surfaces off (RMS), or as registration resolves
  double least_overlap = 0.2;  // share of the scan's samples that must lie on the model

  /// Throws InputError naming the field and its value.
  void validate() const;
};

/// What was found, and the other poses that fit about as well where the shape does not decide between them.
struct AnywhereRegistration {
  Registration best;
  std::vector<Pose> alternatives;  // world from sensor
};

/// Registers a scan of whose pose nothing is believed but that it may be one of these, more or less: they are refined
/// and judged as any other. One that the shape leaves open in some direction, or one of several that fit about as well,
/// is `ambiguous`. The result has the same bits for any number of threads. Throws InputError for options out of range.
[[nodiscard]] AnywhereRegistration register_anywhere(const RegisteredSurface& model, const ScanSurface& scan,
                                                     const std::vector<Pose>& suggested,
                                                     const AnywhereOptions& options = {});

}  // namespace vantage
