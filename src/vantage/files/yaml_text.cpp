#include "vantage/files/yaml_text.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"

namespace vantage {

namespace {

constexpr std::size_t most_yaml_bytes = std::size_t{256} << 10U;

}  // namespace

YAML::Node parse_yaml(std::string_view bytes, const std::string& name) {
  require(bytes.size() <= most_yaml_bytes, name, ": has ", bytes.size(), " bytes; YAML must have at most ",
          most_yaml_bytes);
  try {
    return YAML::Load(std::string(bytes));
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}, line {}: {}", name, error.mark.line + 1, error.msg));
  }
}

std::string place_of(const YAML::Node& node, const std::string& name) {
  if (!node.IsDefined()) return name;  // a key that is missing has no place, and throws where it is asked for one
  const YAML::Mark mark = node.Mark();
  return mark.line < 0 ? name : fmt::format("{}, line {}", name, mark.line + 1);
}

double yaml_number(const YAML::Node& node, std::string_view what, const std::string& name) {
  require(node.IsDefined(), name, ": has no '", what, "'");
  const auto value = node.IsScalar() ? to_double(node.Scalar()) : std::nullopt;
  if (!value || !std::isfinite(*value)) {
    throw InputError(fmt::format("{}: {} = {}: must be a finite number", place_of(node, name), what,
                                 node.IsScalar() ? in_quotes(node.Scalar()) : "(no single value)"));
  }
  return *value;
}

}  // namespace vantage
