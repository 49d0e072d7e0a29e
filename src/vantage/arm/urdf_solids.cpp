#include "vantage/arm/urdf_solids.hpp"

#include <tinyxml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

#include "vantage/core/error.hpp"
#include "vantage/core/number_text.hpp"

namespace vantage {
namespace {

/// An attribute with so many numbers; 0: any text.
struct Attribute {
  std::string_view name;
  int numbers = 0;
  bool may_be_missing = false;
};

/// A shape with its attributes; those without a name are none.
struct UrdfShape {
  std::string_view name;
  std::array<Attribute, 2> attributes;
};

constexpr std::array<UrdfShape, 4> known_shapes{
    UrdfShape{"box", {Attribute{"size", 3}}}, UrdfShape{"cylinder", {Attribute{"radius", 1}, Attribute{"length", 1}}},
    UrdfShape{"sphere", {Attribute{"radius", 1}}},
    UrdfShape{"mesh", {Attribute{"filename", 0}, Attribute{"scale", 3, true}}}};

bool are_numbers(std::string_view text, int count) {
  constexpr std::string_view blanks = " \t\r\n";
  int found = 0;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    if (text.empty()) return found == count;
    const std::string_view word = text.substr(0, text.find_first_of(blanks));
    text.remove_prefix(word.size());
    if (!std::isfinite(number_from<double>(word).value_or(std::numeric_limits<double>::infinity()))) return false;
    ++found;
  }
}

std::string listed(std::span<const Attribute> attributes) {
  std::string text;
  for (const Attribute& each : attributes)
    if (!each.name.empty()) text += concat(text.empty() ? "" : ", ", each.name);
  return text.empty() ? "none" : text;
}

/// That the element has these attributes and no others. `place` says which element of which link.
void check_attributes(const TiXmlElement& element, std::span<const Attribute> known, const std::string& place) {
  const std::string what = concat(place, ": <", element.Value(), ">");
  for (const TiXmlAttribute* each = element.FirstAttribute(); each != nullptr; each = each->Next()) {
    const auto found =
        std::find_if(known.begin(), known.end(), [&](const Attribute& a) { return a.name == each->Name(); });
    require(found != known.end(), what, " has the unknown attribute '", each->Name(), "'; must have ", listed(known));
    require(found->numbers == 0 || are_numbers(each->Value(), found->numbers), what, ": ", each->Name(), " = '",
            each->Value(), "': must be ", found->numbers, found->numbers == 1 ? " number" : " numbers");
  }
  for (const Attribute& each : known) {
    require(each.name.empty() || each.may_be_missing || element.Attribute(std::string(each.name).c_str()) != nullptr,
            what, " has no attribute '", each.name, "'");
  }
}

/// The only element of that name, or of any name where it is null; null where there is none.
const TiXmlElement* only_child(const TiXmlElement& parent, const char* child, const std::string& place) {
  const TiXmlElement* first = child != nullptr ? parent.FirstChildElement(child) : parent.FirstChildElement();
  if (first == nullptr) return nullptr;
  const TiXmlElement* second = child != nullptr ? first->NextSiblingElement(child) : first->NextSiblingElement();
  require(second == nullptr, place, ": <", parent.Value(), "> has more than one ",
          child != nullptr ? concat("<", child, ">") : std::string("shape"), "; write one <collision> for each solid");
  return first;
}

void check_shape(const TiXmlElement& shape, const std::string& place) {
  const std::string name = shape.Value();
  const auto known =
      std::find_if(known_shapes.begin(), known_shapes.end(), [&](const UrdfShape& each) { return each.name == name; });
  require(known != known_shapes.end(), place, ": <", name,
          "> is no shape that can be avoided; must be box, cylinder, sphere or mesh",
          name == "capsule" ? " (a capsule is a cylinder and two spheres, each in a <collision> of its own)" : "");
  check_attributes(shape, known->attributes, place);
}

void check_collision(const TiXmlElement& collision, const std::string& place) {
  constexpr std::array of_collision{Attribute{"name", 0, true}, Attribute{"group", 0, true}};
  constexpr std::array of_origin{Attribute{"xyz", 3, true}, Attribute{"rpy", 3, true}};
  check_attributes(collision, of_collision, place);
  for (const TiXmlElement* part = collision.FirstChildElement(); part != nullptr; part = part->NextSiblingElement()) {
    const std::string name = part->Value();
    require(name == "origin" || name == "geometry" || name == "verbose" || name == "contact_coefficients", place,
            ": <collision> has the unknown part <", name, ">; must have origin and geometry");
  }
  if (const TiXmlElement* origin = only_child(collision, "origin", place)) check_attributes(*origin, of_origin, place);
  const TiXmlElement* geometry = only_child(collision, "geometry", place);
  require(geometry != nullptr, place, ": <collision> has no <geometry>");
  check_attributes(*geometry, {}, place);
  const TiXmlElement* shape = only_child(*geometry, nullptr, place);
  require(shape != nullptr, place, ": <geometry> is empty; must be box, cylinder, sphere or mesh");
  check_shape(*shape, place);
}

bool holds_shape(const TiXmlElement& element) {
  constexpr std::array<std::string_view, 6> names{"geometry", "box", "cylinder", "sphere", "mesh", "capsule"};
  if (std::find(names.begin(), names.end(), element.Value()) != names.end()) return true;
  for (const TiXmlElement* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
    if (holds_shape(*child)) return true;
  return false;
}

std::size_t check_link(const TiXmlElement& link, const std::string& place) {
  std::size_t count = 0;
  for (const TiXmlElement* part = link.FirstChildElement(); part != nullptr; part = part->NextSiblingElement()) {
    const std::string name = part->Value();
    if (name == "collision") {
      check_collision(*part, concat(place, ", collision ", ++count));
    } else {
      require(name == "visual" || name == "inertial" || !holds_shape(*part), place,
              ": has a solid in the unknown element <", name, ">; must be in <collision>");
    }
  }
  return count;
}

}  // namespace

std::map<std::string, std::size_t> check_solids(const TiXmlElement& robot, const std::string& name) {
  std::map<std::string, std::size_t> counts;
  for (const TiXmlElement* part = robot.FirstChildElement(); part != nullptr; part = part->NextSiblingElement()) {
    const std::string kind = part->Value();
    if (kind == "link") {
      const char* link = part->Attribute("name");
      require(link != nullptr, name, ": a link has no name");
      counts[link] = check_link(*part, concat(name, ": link '", link, "'"));
    } else {
      require(
          kind == "joint" || kind == "gazebo" || kind == "material" || kind == "transmission" || !holds_shape(*part),
          name, ": has a solid in <", kind, ">, outside of any link; must be in the <collision> of a link");
    }
  }
  return counts;
}

}  // namespace vantage
