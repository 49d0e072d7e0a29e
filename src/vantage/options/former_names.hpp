#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// The name that an option had before it was renamed. It goes on working until the next minor version, with a hint.
struct FormerName {
  std::string name;
  std::string since;  // the version that gave the option another one
};

/// The former names of the option that is called `name` now.
[[nodiscard]] std::vector<FormerName> former_names(std::string_view name);

/// One line that says how to write it now; `place` is as in errors.
[[nodiscard]] std::string rename_hint(const std::string& place, const FormerName& former, const std::string& now);

}  // namespace vantage
