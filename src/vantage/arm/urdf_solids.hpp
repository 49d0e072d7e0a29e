#pragma once

#include <map>
#include <string>

class TiXmlElement;

namespace vantage {

/// How many solids (elements `collision`) each link of a robot has. The parser of URDF drops those that it does not
/// understand without a word, and an arm would be planned through them; so each must be one that it understands: with
/// one geometry, which is a box, cylinder, sphere or mesh with its attributes and no others. Throws InputError with
/// `name`, the link, the element, and what would be right.
[[nodiscard]] std::map<std::string, std::size_t> check_solids(const TiXmlElement& robot, const std::string& name);

}  // namespace vantage
