#include "vantage/arm/urdf_check.hpp"

#include <tinyxml.h>

#include <algorithm>
#include <initializer_list>
#include <map>

#include "vantage/arm/urdf_solids.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

// The XML parser calls itself once per level, and those who walk over links once per link.
constexpr int deepest = 200;
constexpr std::size_t most_joints = 999;
constexpr std::size_t most_bytes = std::size_t{4} << 20U;
constexpr std::size_t most_attributes = 100;  // of an element; the XML parser compares each with all others

/// The place after `end`, which is searched from `from` on; the end of the text where it does not come.
std::size_t after(std::string_view text, std::string_view end, std::size_t from) {
  const std::size_t at = text.find(end, from);
  return at == std::string_view::npos ? text.size() : at + end.size();
}

/// The place after the tag that begins at `at`, whose attributes may hold any signs in quotes.
std::size_t after_tag(std::string_view text, std::size_t at, const std::string& name) {
  char quote = 0;
  std::size_t attributes = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return at + 1;
    } else if (c == '=') {
      require(++attributes <= most_attributes, name, ": not a robot description (URDF): has an element with more than ",
              most_attributes, " attributes");
    }
  }
  return at;
}

/// Refuses XML whose elements are nested so deeply that the parser's recursion would need more stack than there is, or
/// that has what its messages stumble over.
void require_flat(std::string_view text, const std::string& name) {
  require(text.find('\0') == std::string_view::npos, name, ": not a robot description (URDF): has a byte 0");
  int depth = 0;
  for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      at = after(text, "-->", at + 4);
    } else if (rest.starts_with("<![CDATA[")) {
      at = after(text, "]]>", at);
    } else if (rest.starts_with("<?") || rest.starts_with("<!")) {
      at = after(text, ">", at);
    } else {
      const bool closes = rest.starts_with("</");
      const std::size_t begin = at;
      at = after_tag(text, at, name);
      // The parser hands bad values on to printf() as a format.
      require(text.substr(begin, at - begin).find('%') == std::string_view::npos, name,
              ": not a robot description (URDF): an element has the sign %; only comments may have it");
      const bool is_empty = text[at - 1] == '>' && text[at - 2] == '/';
      depth += closes ? -1 : is_empty ? 0 : 1;
    }
    require(depth <= deepest, name, ": not a robot description (URDF): is nested deeper than ", deepest, " levels");
  }
}

/// The link that an element of a joint names, empty where it names none.
std::string link_in(const TiXmlElement& joint, const char* element) {
  const TiXmlElement* found = joint.FirstChildElement(element);
  const char* link = found == nullptr ? nullptr : found->Attribute("link");
  return link == nullptr ? std::string() : link;
}

/// Refuses joints that make something else than a tree of the links.
void require_tree(const TiXmlElement& robot, const std::string& name) {
  std::map<std::string, std::string> parents;  // of links
  for (const TiXmlElement* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const std::string child = link_in(*joint, "child"), parent = link_in(*joint, "parent");
    if (child.empty() || parent.empty()) continue;  // the parser says what is missing
    require(parents.emplace(child, parent).second, name, ": two joints have the child link '", child, "'");
    require(parents.size() <= most_joints, name, ": has more than ", most_joints, " joints");
  }
  for (const auto& [link, ignored] : parents) {
    std::size_t steps = 0;
    for (auto up = parents.find(link); up != parents.end(); up = parents.find(up->second)) {
      require(++steps <= parents.size(), name, ": the joints above link '", link, "' go round in a circle");
    }
  }
}

/// Removes all elements but those of these names.
void keep_only(TiXmlElement& parent, std::initializer_list<std::string_view> names) {
  for (TiXmlElement* child = parent.FirstChildElement(); child != nullptr;) {
    TiXmlElement* const next = child->NextSiblingElement();
    if (std::find(names.begin(), names.end(), child->Value()) == names.end()) parent.RemoveChild(child);
    child = next;
  }
}

}  // namespace

CheckedUrdf check_urdf(std::string_view text, const std::string& name) {
  require_flat(text, name);
  require(text.size() <= most_bytes, name, ": has ", text.size(), " bytes; a robot description must have at most ",
          most_bytes);
  TiXmlDocument document;
  document.Parse(std::string(text).c_str());
  TiXmlElement* robot = document.FirstChildElement("robot");
  if (document.Error() || robot == nullptr) return {std::string(text), {}};  // the parser says what is wrong
  require_tree(*robot, name);
  CheckedUrdf checked{{}, check_solids(*robot, name)};
  keep_only(*robot, {"link", "joint"});
  for (TiXmlElement* link = robot->FirstChildElement("link"); link != nullptr; link = link->NextSiblingElement("link"))
    keep_only(*link, {"collision"});
  TiXmlPrinter printer;
  document.Accept(&printer);
  checked.text = printer.Str();
  return checked;
}

}  // namespace vantage
