#pragma once

#include <optional>
#include <vector>

#include "arrays.hpp"
#include "vantage/recordings/scan_folder.hpp"

namespace vantage::python {

/// A depth image in an array, as a driver gives it.
struct DepthInput {
  py::array depth;                 // uint16 or floating-point (rows, columns)
  DoubleArray intrinsics;          // (3, 3), pixels
  std::vector<double> distortion;  // k1 k2 p1 p2 k3 k4 k5 k6, or fewer
  std::optional<py::array> mask;   // (rows, columns), zero where a pixel does not count
};

/// The scan and the pose of its sensor, by the options of reading: `reported` is the pose that the robot reports.
/// Throws InputError naming the argument.
[[nodiscard]] std::pair<Scan, View> read_depth(const DepthInput& input, const Pose& reported,
                                               const ScanFolderOptions& options);

}  // namespace vantage::python
