#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// Poses of one frame in its parent over time: between two samples they are interpolated (position on the straight
/// line, rotation by slerp), next to the first and the last one these count for 20 ms.
class PoseTrack {
 public:
  struct Sample {
    std::int64_t time_ns = 0;
    std::uint32_t parent = 0;  // number of a frame
    Vec3 translation = Vec3::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    [[nodiscard]] Pose pose() const;
  };

  void add(std::int64_t time_ns, std::uint32_t parent, const Pose& parent_from_child);
  /// Sorts the samples; to be called once before the others. Of two samples at one time the later one counts.
  void finish();

  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  [[nodiscard]] std::uint32_t last_parent() const { return samples_.back().parent; }
  [[nodiscard]] double duration_s() const;
  /// Whether any two poses differ.
  [[nodiscard]] bool moves() const;
  /// The sample at this time, or none and the reason.
  [[nodiscard]] std::pair<std::optional<Sample>, std::string> at(std::int64_t time_ns) const;
  [[nodiscard]] const Sample& last() const { return samples_.back(); }

 private:
  [[nodiscard]] std::pair<std::optional<Sample>, std::string> between(const Sample& before, const Sample& after,
                                                                      std::int64_t time_ns) const;

  std::vector<Sample> samples_;
  std::int64_t longest_gap_ns_ = 0;
};

}  // namespace vantage
