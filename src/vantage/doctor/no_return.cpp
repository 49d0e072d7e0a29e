#include "vantage/doctor/no_return.hpp"

#include <cmath>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr double mostly = 0.7;     // of the pixels unknown: there is no background
constexpr double scattered = 0.3;  // of the pixels that meet nothing: background has few of them along its outlines
constexpr double hardly = 0.001;   // of the pixels are reported to meet nothing

}  // namespace

std::vector<Finding> check_no_return(const Evidence& evidence) {
  if (!evidence.camera) return {};  // clouds hold points alone
  double unknown = 0, no_return = 0, strewn = 0, masked = 0;
  for (const FrameEvidence& frame : evidence.frames) {
    const double part = 1 / static_cast<double>(evidence.frames.size());
    unknown += part * frame.unknown;
    no_return += part * frame.no_return;
    strewn += part * frame.strewn;
    masked += frame.is_masked ? part : 0;
  }
  if (no_return > hardly && strewn > scattered) {
    return {{"no-return",
             "\"nothing is there\" is reported in the midst of surfaces: the value means that nothing was measured",
             "give that value with --unknown (inf, or a number) instead of --no-return; else the inside of things is "
             "taken for "
             "free space",
             concat(std::round(1000 * no_return) / 10, " % of the pixels report that nothing is there, ",
                    std::round(100 * strewn), " % of these lie among measured ones")}};
  }
  if (masked > 0) return {};  // it is the masks that say nothing
  if (unknown < mostly || no_return > hardly) return {};
  return {{"no-return", "the sensor never reports \"no return\": where it meets nothing the frames say \"unknown\"",
           "write a value of its own where nothing is met within the far limit and give it with --no-return, or put a "
           "surface behind the object; otherwise the space around it stays unknown",
           concat(std::round(1000 * unknown) / 10, " % of the pixels are unknown, ", std::round(1000 * no_return) / 10,
                  " % say that nothing is there"),
           true}};
}

}  // namespace vantage
