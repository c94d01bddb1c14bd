#include "bindings/progress_function.h"

#include <pybind11/pybind11.h>

namespace spectral_conformal::python {

Progress progress_of(const pybind11::object& callable) {
  return [&callable](double fraction, const char* phase) {
    const pybind11::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
    if (callable.is_none()) return true;
    const pybind11::object answer = callable(fraction, phase);
    if (answer.is_none()) return true;
    const int truth = PyObject_IsTrue(answer.ptr());
    if (truth < 0) throw pybind11::error_already_set();
    return truth != 0;
  };
}

}  // namespace spectral_conformal::python
