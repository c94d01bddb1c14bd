#include <pybind11/pybind11.h>

#include <exception>
#include <new>

#include "bindings/bind.h"
#include "bindings/options.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::python {

namespace py = pybind11;

void bind_errors(pybind11::module_& module) {
  // Local to this module: a bundled copy and an installed one may be loaded side by side.
  pybind11::register_local_exception<InvalidMesh>(module, "InvalidMeshError", PyExc_ValueError);
  // The class that SolveFailure is raised as, with its step: the sentence is made in Python.
  static PyObject* solve_error = nullptr;
  module.def("raise_solve_failures_as", [](const py::object& type) { solve_error = py::object(type).release().ptr(); });
  pybind11::register_local_exception<Cancelled>(module, "Cancelled", PyExc_Exception);
  // pybind11 would make it a MemoryError that says "std::bad_alloc".
  pybind11::register_local_exception_translator([](std::exception_ptr problem) {
    try {
      if (problem) std::rethrow_exception(problem);
    } catch (const SolveFailure& failure) {
      PyErr_SetObject(solve_error ? solve_error : PyExc_RuntimeError, steps_of({failure.step()}).ptr());
    } catch (const std::bad_alloc&) {
      PyErr_SetString(
          PyExc_MemoryError,
          "There is too little memory for this mesh; close other programs, or unwrap fewer or coarser faces.");
    }
  });
}

}  // namespace spectral_conformal::python
