#pragma once

#include <yaml-cpp/node/node.h>

#include <string>
#include <string_view>

namespace vantage {

/// Parses one YAML document; throws InputError with `name` and the line where it is not well formed. The parser takes
/// some hundred bytes of memory for each byte of its input, so that must have at most 256 KiB.
[[nodiscard]] YAML::Node parse_yaml(std::string_view bytes, const std::string& name);

/// "NAME, line N" of a node, for errors.
[[nodiscard]] std::string place_of(const YAML::Node& node, const std::string& name);

/// The node as a finite number; throws InputError with the place and `what`.
[[nodiscard]] double yaml_number(const YAML::Node& node, std::string_view what, const std::string& name);

}  // namespace vantage
