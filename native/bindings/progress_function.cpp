#include "bindings/progress_function.h"

#include <pybind11/pybind11.h>

#include <string_view>

namespace spectral_conformal::python {

namespace {

/// Whether an answer is False, or NumPy's. Others go on: a function that returns what it printed or counted does not
/// mean to cancel.
bool is_false(const pybind11::object& answer) {
  if (answer.is(pybind11::handle(Py_False))) return true;
  const std::string_view type = Py_TYPE(answer.ptr())->tp_name;
  if (type != "numpy.bool_" && type != "numpy.bool") return false;
  return !pybind11::cast<bool>(answer);
}

}  // namespace

Progress progress_of(const pybind11::object& callable) {
  return [&callable](double fraction, const char* phase) {
    const pybind11::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
    if (callable.is_none()) return true;
    return !is_false(callable(fraction, phase));
  };
}

}  // namespace spectral_conformal::python
