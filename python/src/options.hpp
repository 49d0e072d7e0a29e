#pragma once

#include <string>
#include <vector>

#include "arrays.hpp"
#include "vantage/options/options.hpp"

namespace vantage::python {

/// Sets the options that the keywords name: `max_views=5` is the command line's `--max-views 5`. Lists, tuples and
/// arrays stand for numbers with commas between, None for no value. Throws InputError for an unknown name (with the
/// nearest one) or a value of the wrong kind; `function` is named in its text.
void set_options(const std::vector<OptionField>& fields, const py::kwargs& keywords, const std::string& function);

/// One line per option for a docstring: name, default, unit and meaning.
[[nodiscard]] std::string options_text(const std::vector<OptionField>& fields);

/// The options as dictionaries with the keys name (as a keyword), default, unit and meaning.
[[nodiscard]] py::list options_list(const std::vector<OptionField>& fields);

}  // namespace vantage::python
