#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/doctor/hypothesis.hpp"

namespace vantage {

std::vector<Hypothesis> shifted_times(const Reading& base, std::size_t every) {
  constexpr int farthest = 5;  // frames that are looked at
  const auto count = static_cast<int>(base.world_from_sensor.size());
  std::vector<Hypothesis> hypotheses;
  for (int shift = -farthest; shift <= farthest; ++shift) {
    if (shift == 0 || std::abs(shift) >= count) continue;
    Hypothesis each{"time", {}, {}, base};
    for (int i = 0; i < count; ++i) {
      // Poses at the ends that would come from outside stay out of place: there is none to put there.
      const auto from = static_cast<std::size_t>((i + shift + count) % count);
      each.reading.world_from_sensor[static_cast<std::size_t>(i)] = base.world_from_sensor[from];
    }
    const int frames = std::abs(shift) * static_cast<int>(every);
    const char* direction = shift > 0 ? "later" : "earlier";
    each.wrong = concat("the trajectory is shifted in time: each frame fits the pose of the frame ", frames,
                        frames == 1 ? " place " : " places ", direction);
    each.fix = concat("compare the clocks of camera and robot; here the pose of a frame stands ", frames,
                      frames == 1 ? " frame " : " frames ", direction, " than it");
    hypotheses.push_back(std::move(each));
  }
  return hypotheses;
}

}  // namespace vantage
