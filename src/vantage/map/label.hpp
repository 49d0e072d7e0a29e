#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace vantage {

/// What is known of a voxel (paper, section 4). The numbers are those of the map file.
enum class Label : std::uint8_t { unmarked = 0, occupied = 1, empty = 2, occluded = 3, occplane = 4 };

inline constexpr std::array<Label, 5> all_labels{Label::unmarked, Label::occupied, Label::empty, Label::occluded,
                                                 Label::occplane};

[[nodiscard]] constexpr std::string_view name(Label label) {
  constexpr std::array<std::string_view, 5> names{"unmarked", "occupied", "empty", "occluded", "occplane"};
  return names[static_cast<std::size_t>(label)];
}

}  // namespace vantage
