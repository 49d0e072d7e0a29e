#include "vantage/doctor/no_return.hpp"

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr double mostly = 0.7;    // of the pixels unknown: there is no background
constexpr double hardly = 0.001;  // of the pixels are told to meet nothing

}  // namespace

std::vector<Finding> check_no_return(const Evidence& evidence) {
  if (!evidence.camera) return {};  // clouds hold points alone
  double unknown = 0, no_return = 0;
  for (const FrameEvidence& frame : evidence.frames) {
    unknown += frame.unknown / static_cast<double>(evidence.frames.size());
    no_return += frame.no_return / static_cast<double>(evidence.frames.size());
  }
  if (unknown < mostly || no_return > hardly) return {};
  return {{"no-return", "the sensor never reports \"no return\": where it meets nothing the frames say \"unknown\"",
           "write a value of its own where nothing is met within the far limit and give it with --no-return, or put a "
           "surface behind the object; otherwise the space around it stays unknown",
           concat(std::round(1000 * unknown) / 10, " % of the pixels are unknown, ", std::round(1000 * no_return) / 10,
                  " % say that nothing is there")}};
}

}  // namespace vantage
