#pragma once

#include <string_view>

namespace vantage {

/// True where `a` comes before `b` when numbers in them are compared by value: frame-9 before frame-10. Names that
/// differ only in leading zeros are ordered letter by letter.
[[nodiscard]] bool comes_before(std::string_view a, std::string_view b);

}  // namespace vantage
