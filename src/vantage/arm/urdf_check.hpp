#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// Refuses what the parser of URDF would not survive or never let go of: elements nested so deeply that its recursion
/// runs out of stack, signs that its messages take for commands, more than 1000 links, and joints that go round in a
/// circle, which makes links own each other for ever. Throws InputError starting with `name`.
void check_urdf(std::string_view text, const std::string& name);

}  // namespace vantage
