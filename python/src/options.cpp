#include "options.hpp"

#include <algorithm>

namespace vantage::python {
namespace {

std::string keyword_of(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

/// The field that the keyword names, with a warning where it is a former name.
std::vector<OptionField>::const_iterator field_of(const std::vector<OptionField>& fields, const std::string& keyword) {
  for (auto field = fields.begin(); field != fields.end(); ++field) {
    if (keyword_of(field->name) == keyword) return field;
    for (const FormerName& former : field->former) {
      if (keyword_of(former.name) != keyword) continue;
      const std::string hint = rename_hint(keyword, former, keyword_of(field->name));
      if (PyErr_WarnEx(PyExc_FutureWarning, hint.c_str(), 1) != 0) throw py::error_already_set();
      return field;
    }
  }
  return fields.end();
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
    const auto field = field_of(fields, name);
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
