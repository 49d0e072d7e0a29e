#pragma once

#include <memory>
#include <span>
#include <vector>

#include "vantage/registration/scan_surface.hpp"

namespace vantage {

/// Finds the sample that is nearest in place and normal together, however far away: for poses that are still far off.
/// Queries may run on several threads at once.
class OrientedIndex {
 public:
  /// Over at most `most` of the samples, evenly picked. A normal that differs by 60 degrees counts as much as a
  /// distance of `length` metres.
  OrientedIndex(std::span<const SurfaceSample> samples, std::size_t most, double length);
  ~OrientedIndex();
  OrientedIndex(const OrientedIndex&) = delete;
  OrientedIndex& operator=(const OrientedIndex&) = delete;

  /// Nothing where no sample faces the same way within 60 degrees where the nearest one is.
  [[nodiscard]] const SurfaceSample* nearest(const SurfaceSample& query) const;
  /// One in so many samples is in the index.
  [[nodiscard]] std::size_t stride() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace vantage
