#pragma once

#include <vector>

#include "vantage/registration/pose_search.hpp"
#include "vantage/registration/registration.hpp"

namespace vantage {

/// Fewer samples say nothing of a pose: five for each number that it has.
constexpr std::size_t least_samples = 30;

/// Gives the verdict on the peaks of a search, with the number that it rests on.
class PoseJudge {
 public:
  /// `search` must outlive the judge. `sigma`: typical standard deviation of a measured depth, metres.
  PoseJudge(const PoseSearch& search, const RegistrationOptions& options, double sigma)
      : search_(search), options_(options), sigma_(sigma) {}

  /// Of the first mode, which is the most probable one; the others are its rivals.
  [[nodiscard]] Registration judged(const std::vector<PoseMode>& modes) const;

 private:
  [[nodiscard]] Registration described(const PoseMode& mode) const;
  [[nodiscard]] double rival(const std::vector<PoseMode>& modes) const;
  bool refuse_overlap(const PoseMode& mode, Registration& result) const;
  bool refuse_prior(const PoseMode& mode, Registration& result) const;
  bool refuse_fit(const PoseMode& mode, Registration& result) const;
  bool refuse_free_space(const PoseMode& mode, Registration& result) const;
  bool refuse_open(Registration& result) const;
  bool refuse_rival(Registration& result) const;
  void accept(Registration& result) const;

  const PoseSearch& search_;
  RegistrationOptions options_;
  double sigma_;
};

}  // namespace vantage
