#include "options.hpp"

#include <algorithm>

namespace vantage::python {
namespace {

std::string keyword_of(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

/// A value as the command line writes it.
std::string text_of(py::handle value) {
  if (value.is_none()) return std::string(no_value);
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value) || py::isinstance<py::array>(value)) {
    std::string text;
    for (const py::handle item : value) {
      text += (text.empty() ? "" : ",") + text_of(item);
    }
    return text;
  }
  return py::str(value);
}

}  // namespace

void set_options(const std::vector<OptionField>& fields, const py::kwargs& keywords, const std::string& function) {
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&](const OptionField& each) { return keyword_of(each.name) == name; });
    if (field == fields.end()) {
      std::vector<std::string> names;
      for (const OptionField& each : fields) names.push_back(keyword_of(each.name));
      const std::string nearest = nearest_name(name, names);
      throw InputError(concat(function, ": unknown option '", name, "'",
                              nearest.empty() ? "; its help lists them" : "; did you mean '" + nearest + "'?"));
    }
    set_option(*field, text_of(value), name);
  }
}

std::string options_text(const std::vector<OptionField>& fields) {
  std::string text;
  for (const OptionField& field : fields) {
    text += concat("    ", keyword_of(field.name), " = ", field.text(),
                   field.unit.empty() ? "" : " [" + field.unit + "]", ": ", field.meaning, "\n");
  }
  return text;
}

py::list options_list(const std::vector<OptionField>& fields) {
  py::list list;
  for (const OptionField& field : fields) {
    py::dict entry;
    entry["name"] = keyword_of(field.name);
    entry["default"] = field.text();
    entry["unit"] = field.unit;
    entry["meaning"] = field.meaning;
    list.append(entry);
  }
  return list;
}

}  // namespace vantage::python
