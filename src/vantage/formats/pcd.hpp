#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/core/geometry.hpp"
#include "vantage/sensor/range_camera.hpp"

namespace vantage {

/// The fields of a PCD file that hold one number per point.
struct Pcd {
  struct Field {
    std::string name;
    std::vector<double> values;
  };
  Resolution size{0, 0};  // WIDTH x HEIGHT
  std::vector<Field> fields;
  Pose viewpoint = Pose::Identity();

  /// nullptr where there is no such field.
  [[nodiscard]] const std::vector<double>* find(std::string_view field) const;
};

/// DATA ascii, binary or binary_compressed. Throws InputError with `name` and the place. Memory stays within a small
/// multiple of the data, whatever the header promises; compressed data may be 88 times as long, but must not have more
/// than `most_values`.
[[nodiscard]] Pcd parse_pcd(std::string_view bytes, const std::string& name,
                            std::size_t most_values = std::numeric_limits<std::size_t>::max());

}  // namespace vantage
