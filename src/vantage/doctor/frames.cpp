#include "vantage/doctor/frames.hpp"

#include <algorithm>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

std::string first_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (text.empty() ? "" : ", ") + names[i];
  return names.size() > most ? concat(text, " and ", names.size() - most, " more") : text;
}

}  // namespace

std::vector<Finding> check_frames(const Evidence& evidence) {
  std::vector<Finding> findings;
  const std::size_t all = evidence.frames.size() + evidence.empty.size();
  if (!evidence.empty.empty()) {
    findings.push_back(
        {"frames", concat(evidence.empty.size(), " of ", all, " frames are empty: ", first_of(evidence.empty)),
         "leave them out; see whether the sensor had started, or whether a mask or the crop box takes all away",
         "no pixel of them holds a depth"});
  }
  if (evidence.frames.size() == 1) {
    findings.push_back({"frames", "there is one frame only: nothing can be compared",
                        "give two frames or more that see the same thing",
                        "poses, axes, units and times are examined by what frames say of each other"});
  }
  return findings;
}

}  // namespace vantage
