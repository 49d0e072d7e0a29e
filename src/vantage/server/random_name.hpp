#pragma once

#include <string>

namespace vantage {

/// 32 hexadecimal digits from the operating system, which nobody can guess: names of runs and access tokens. Not for
/// anything that has to repeat.
[[nodiscard]] std::string random_name();

}  // namespace vantage
