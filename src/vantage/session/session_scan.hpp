#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vantage/core/error.hpp"
#include "vantage/map/scan.hpp"
#include "vantage/model/registrar.hpp"

namespace vantage {

/// A scan as it comes into a session.
struct SessionScan {
  std::string name;                    // what people call it
  View believed;                       // the robot's pose
  Scan scan;                           // in the sensor's frame
  std::optional<int> candidate;        // the candidate view that it was taken from, where it was a planned one
  std::optional<View> commanded = {};  // where the sensor was sent; without it, the candidate's view at that time
  std::string key = {};                // the sender's own: a session stores only one scan with it

  /// Throws InputError where the scan or its pose has numbers that are not finite.
  void validate() const;
};

/// All of a scan as bytes, the numbers to the last bit: a line of JSON, then arrays, little endian.
[[nodiscard]] std::string scan_bytes(const SessionScan& scan);
/// What was measured and from where, as bytes: two scans with the same ones are one scan, whatever they are called.
[[nodiscard]] std::string measured_bytes(const SessionScan& scan);

/// A file of a newer version of the program, which is as it should be.
class NewerFormat : public Error {
 public:
  using Error::Error;
};

/// The scan that scan_bytes() wrote. Throws InputError starting with `name` where the bytes are something else, and
/// NewerFormat.
[[nodiscard]] SessionScan parse_scan(std::string_view bytes, const std::string& name);

/// What registration found for the scan with this checksum (sealed_file.hpp), as JSON that parse_located() reads to the
/// last bit.
[[nodiscard]] std::string located_text(const Located& located, const std::string& scan_checksum);
/// Throws InputError starting with `name` where the bytes are something else.
struct StoredLocated {
  Located located;
  std::string scan_checksum;
};
[[nodiscard]] StoredLocated parse_located(std::string_view bytes, const std::string& name);

}  // namespace vantage
