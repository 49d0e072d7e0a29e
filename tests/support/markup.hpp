#pragma once

#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <functional>
#include <string>
#include <vector>

namespace vantage {

/// Markup that a test has parsed; a test fails where it is not well formed.
class ParsedMarkup {
 public:
  explicit ParsedMarkup(const std::string& text) {
    EXPECT_EQ(document_.Parse(text.c_str(), text.size()), tinyxml2::XML_SUCCESS) << document_.ErrorStr();
  }
  /// All elements with this name and, unless empty, this word in their class, in document order.
  [[nodiscard]] std::vector<const tinyxml2::XMLElement*> all(const std::string& name,
                                                             const std::string& word = "") const {
    std::vector<const tinyxml2::XMLElement*> found;
    const std::function<void(const tinyxml2::XMLElement*)> visit = [&](const tinyxml2::XMLElement* element) {
      for (; element != nullptr; element = element->NextSiblingElement()) {
        const char* css_class = element->Attribute("class");
        std::string words = " ";
        words += css_class != nullptr ? css_class : "";
        words += ' ';
        if (name == element->Name() && (word.empty() || words.find(" " + word + " ") != std::string::npos))
          found.push_back(element);
        visit(element->FirstChildElement());
      }
    };
    visit(document_.FirstChildElement());
    return found;
  }
  /// The texts of all <text> elements.
  [[nodiscard]] std::vector<std::string> texts() const {
    std::vector<std::string> result;
    for (const tinyxml2::XMLElement* element : all("text")) result.emplace_back(element->GetText());
    return result;
  }

 private:
  tinyxml2::XMLDocument document_;
};

}  // namespace vantage
