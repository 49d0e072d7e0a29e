#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vantage/utility/gain.hpp"

namespace vantage {

/// How many unknown voxels there are of each class of GainOptions::worth.
using ClassCounts = std::array<std::int32_t, 4>;

/// The unknown voxels that the views of a choice meet, numbered class by class, each class from a new word on; and
/// which of them each view meets.
struct MetVoxels {
  static constexpr std::size_t classes = 4;

  std::array<std::size_t, classes + 1> first_word{};  // of each class, and the end
  std::vector<std::vector<std::uint64_t>> of_view;
  std::vector<std::int64_t> occupied;  // met, of each view
  std::vector<char> looked;            // whether there was time for the view

  [[nodiscard]] double worth(const std::array<double, classes>& of_class, const ClassCounts& counts) const;
  /// How many of each class `view` meets that are not among `without`.
  [[nodiscard]] ClassCounts counts(const std::vector<std::uint64_t>& view, const std::uint64_t* without) const;
  /// What any of the views meets.
  [[nodiscard]] std::vector<std::uint64_t> any() const;
};

/// What the views of the choice meet, as gain looks at them.
[[nodiscard]] MetVoxels meet(const Choice& choice, const GainOptions& options);

/// Which views overlap enough and are worth something; the floor falls until there are some.
[[nodiscard]] std::vector<char> overlapping(const MetVoxels& met, const std::vector<ClassCounts>& counts,
                                            const std::vector<double>& worth, int refused, const GainOptions& options);

}  // namespace vantage
