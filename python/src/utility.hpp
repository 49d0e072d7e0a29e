#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "arrays.hpp"
#include "vantage/utility/utility.hpp"

namespace vantage::python {

using CountFunction = std::function<py::object(const Visibility&, const Factors&)>;

/// A function of Python that scores all views at once, with what it needs.
struct SetFunction {
  py::function function;
  bool needs_all_views = false;
  bool skips_scanned_views = false;
};

/// What stands for a utility in Python: a name, or a function of either kind.
using AnyUtility = std::variant<std::string, SetFunction, CountFunction>;

/// The name, where it is one.
[[nodiscard]] std::optional<std::string> name_of(const AnyUtility& utility);
/// The utility that calls the function, where it is none that goes by name. It takes the interpreter's lock while it
/// calls; what the function raises comes through.
[[nodiscard]] std::optional<Utility> utility_of(const AnyUtility& utility);

}  // namespace vantage::python
