#pragma once

#include "vantage/doctor/reading.hpp"

namespace vantage {

/// What frames say of each other's points: shares of all points that were asked for, 0..1. The rest was not in view, or
/// nothing is known there.
struct Consistency {
  double agrees = 0;     // a surface is seen there, from the same side
  double floats = 0;     // the other frame sees through the point
  double backwards = 0;  // a surface is seen there, but from behind
  double hidden = 0;     // the other frame sees something before it, which is as it may be

  /// Share of what contradicts among all that was looked at; 0 where nothing was.
  [[nodiscard]] double contradiction() const;
  /// What speaks for a reading less what speaks against it.
  [[nodiscard]] double score() const { return agrees - floats - backwards; }
  [[nodiscard]] double looked_at() const { return agrees + floats + backwards; }
};

/// How well the frames fit each other when they are read in one way. Tolerances are in proportion to depth, so that a
/// reading that makes the world small gains nothing. Of line scanners, which see in no one direction, agreement() alone
/// speaks. The same for any number of threads.
[[nodiscard]] Consistency consistency(const Evidence& evidence, const Reading& reading);
/// The same for each frame with the others, both ways.
[[nodiscard]] std::vector<Consistency> consistency_of_frames(const Evidence& evidence, const Reading& reading);

/// How far the frames are from fitting each other, 0..1: every point counts by how far it is from what the other frame
/// sees, in units of `reach` times the depth, and 1 from there on. For searches, which need a slope.
[[nodiscard]] double misfit(const Evidence& evidence, const Reading& reading, double reach);

}  // namespace vantage
