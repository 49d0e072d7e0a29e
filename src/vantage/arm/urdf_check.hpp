#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace vantage {

/// A description that the parser of URDF can be given.
struct CheckedUrdf {
  std::string text;                           // without what is only looked at, weighed or simulated
  std::map<std::string, std::size_t> solids;  // elements `collision` of each link
};

/// Refuses what the parser of URDF would not survive or never let go of: elements nested so deeply that its recursion
/// runs out of stack, more than 4 MB, or 100 attributes in an element, which it compares with each other, signs that
/// its messages take for commands, more than 1000 links, joints that go round in a circle, which makes links own each
/// other for ever, and solids that it would drop (urdf_solids.hpp). Elements that play no part here are taken out: the
/// parser drops a whole link, solids and all, where it does not understand how it looks or what it weighs. Throws
/// InputError starting with `name`.
[[nodiscard]] CheckedUrdf check_urdf(std::string_view text, const std::string& name);

}  // namespace vantage
