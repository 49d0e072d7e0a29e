#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/core/error.hpp"
#include "vantage/experiments/sweep_object.hpp"

namespace vantage {

/// What the paper publishes of one object: tables 1, 2 and 4.
struct PublishedObject {
  const char* name;
  double size;  // metres, largest side (spec, section 8)
  double views, occupied;
  double quality_exhaustive, quality_multi_resolution;
  double distance_exhaustive, distance_multi_resolution;
  double distance_with_navigation, distance_without_navigation;
  double quality_band;  // half width (spec, section 9)
};

inline constexpr std::array<PublishedObject, 7> published_objects{{
    {"sphere", 0.815, 6, 7200, .757, .757, 17.70, 17.70, 17.7, 20.9, .09},
    {"pear", 0.815, 7, 4330, .803, .803, 16.40, 16.40, 16.4, 19.7, .09},
    {"banana", 0.815, 4, 1050, .803, .765, 9.54, 7.15, 7.15, 9.50, .09},
    {"mug", 0.815, 8, 7736, .718, .718, 21.76, 21.76, 21.7, 22.7, .09},
    {"bunny", 0.815, 9, 5392, .825, .821, 21.32, 23.56, 23.5, 23.8, .09},
    {"dragon", 0.815, 9, 3595, .777, .798, 24.46, 22.14, 22.1, 28.4, .13},
    {"sgi_logo", 1.09, 12, 11952, .843, .832, 34.02, 32.53, 32.5, 37.0, .09},
}};

/// An object of the paper as it can be had here.
struct PaperObject {
  PublishedObject published;
  std::shared_ptr<const SweepObject> object;

  /// Name and source, for people.
  [[nodiscard]] std::string title() const { return concat(object->name(), " (", object->source(), ")"); }
};

/// The paper's objects: `NAME.ply` of the folder where there is one, else the built-in object of that name; those that
/// are neither are left out. Throws InputError where the folder does not exist.
[[nodiscard]] std::vector<PaperObject> paper_objects(const std::optional<std::filesystem::path>& folder);
/// One of them; throws InputError where it cannot be had.
[[nodiscard]] PaperObject paper_object(const std::string& name, const std::optional<std::filesystem::path>& folder);

}  // namespace vantage
