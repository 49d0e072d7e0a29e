#include "vantage/options/former_names.hpp"

#include <fmt/format.h>

#include <array>

namespace vantage {
namespace {

struct Renamed {
  const char* before;
  const char* now;
  const char* in;  // version
};

// A renamed option gets a line here, which the next minor version takes away again: {"voxel-size", "voxel", "0.3.0"}.
// Names are those of the option tables, so one line serves the command line, YAML and Python. Every option of 0.1.0
// still has its name.
constexpr std::array<Renamed, 0> all_renamed{};

}  // namespace

std::vector<FormerName> former_names(std::string_view name) {
  std::vector<FormerName> names;
  for (const Renamed& each : all_renamed)
    if (name == each.now) names.push_back({each.before, each.in});
  return names;
}

std::string rename_hint(const std::string& place, const FormerName& former, const std::string& now) {
  return fmt::format("{} is called {} since version {}; the former name goes on working for one version", place, now,
                     former.since);
}

}  // namespace vantage
