#include <exception>

#include "bindings.hpp"

namespace vantage::python {
namespace {

py::object new_exception(const char* name, const char* meaning, const py::tuple& bases) {
  return py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(name, meaning, bases.ptr(), nullptr));
}

/// The class of the module, found by name so that nothing global has to hold it.
void raise(const char* name, const char* text) {
  const py::object type = py::module_::import("vantage._vantage").attr(name);
  PyErr_SetString(type.ptr(), text);
}

}  // namespace

void bind_errors(py::module_& module) {
  const auto base = [](PyObject* type) { return py::reinterpret_borrow<py::object>(type); };
  module.attr("Error") = new_exception("vantage.Error",
                                       "What went wrong at run time: an unreadable file, a full disk. The text is that "
                                       "of the program `vantage`.",
                                       py::make_tuple(base(PyExc_RuntimeError)));
  module.attr("InputError") = new_exception(
      "vantage.InputError",
      "Misuse or bad input: the text names the field, file or line, the value and what would be right. An Error too.",
      py::make_tuple(module.attr("Error"), base(PyExc_ValueError)));
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const vantage::InputError& error) {
      raise("InputError", error.what());
    } catch (const vantage::Error& error) {
      raise("Error", error.what());
    }
  });
}

}  // namespace vantage::python
