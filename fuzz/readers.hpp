#pragma once

#include <string_view>
#include <vector>

namespace vantage::fuzz {

/// A reader of a file format with any bytes as its input: it must return or throw InputError, nothing else.
struct Reader {
  std::string_view name;
  std::string_view group;  // readers of like formats, which share a fuzzer and what it finds
  void (*read)(std::string_view bytes);
};

/// Readers of scans, poses, maps, sessions and results. `corpus/GROUP/NAME` has inputs for each.
[[nodiscard]] const std::vector<Reader>& file_readers();
/// Readers of options, robots and bodies of HTTP requests, which need the planner.
[[nodiscard]] const std::vector<Reader>& option_readers();

/// Readers of ROS bags, their messages and their compression.
[[nodiscard]] const std::vector<Reader>& bag_readers();

}  // namespace vantage::fuzz
