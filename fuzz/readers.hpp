#pragma once

#include <string_view>
#include <vector>

namespace vantage::fuzz {

/// A reader of a file format with any bytes as its input: it must return or throw InputError, nothing else.
struct Reader {
  std::string_view name;
  void (*read)(std::string_view bytes);
};

/// Every reader that takes bytes from outside. `corpus/NAME` has inputs for each.
[[nodiscard]] const std::vector<Reader>& readers();

}  // namespace vantage::fuzz
