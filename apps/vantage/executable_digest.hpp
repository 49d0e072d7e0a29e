#pragma once

#include <string>

namespace vantage::app {

/// 16 hexadecimal digits that every build of the program has for itself: what one build has computed is not taken for
/// the result of another.
[[nodiscard]] std::string executable_digest();

}  // namespace vantage::app
