#include <pybind11/pybind11.h>

#include <exception>
#include <new>

#include "bindings/bind.h"
#include "bindings/options.h"
#include "bindings/turns.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::python {

namespace py = pybind11;

void bind_errors(pybind11::module_& module) {
  // Local to this module: a bundled copy and an installed one may be loaded side by side.
  pybind11::register_local_exception<InvalidMesh>(module, "InvalidMeshError", PyExc_ValueError);
  static PyObject* const invalid_mesh = module.attr("InvalidMeshError").ptr();
  // The Python class for SolveFailure, which carries its step, and the function that puts the step of an InvalidMesh
  // into words.
  static PyObject* solve_error = PyExc_RuntimeError;
  static PyObject* describe = nullptr;
  // Sentences, the first made early, when there is memory for it.
  static PyObject* out_of_memory = Py_None;
  static PyObject* reentered = Py_None;
  module.def("put_errors_into_words", [](py::object type, py::object words, py::object memory, py::object again) {
    solve_error = type.release().ptr();
    describe = words.release().ptr();
    out_of_memory = memory.release().ptr();
    reentered = again.release().ptr();
  });
  pybind11::register_local_exception<Cancelled>(module, "Cancelled", PyExc_Exception);
  // pybind11 would raise a MemoryError saying "std::bad_alloc".
  pybind11::register_local_exception_translator([](std::exception_ptr problem) {
    try {
      if (problem) std::rethrow_exception(problem);
    } catch (const SolveFailure& failure) {
      PyErr_SetObject(solve_error, steps_of({failure.step()}).ptr());
    } catch (const InvalidMesh& broken) {
      if (!describe) throw;
      PyErr_SetObject(invalid_mesh, py::handle(describe)(steps_of({broken.step()})).ptr());
    } catch (const Reentered&) {
      PyErr_SetObject(PyExc_RuntimeError, reentered);
    } catch (const std::bad_alloc&) {
      PyErr_SetObject(PyExc_MemoryError, out_of_memory);
    }
  });
}

}  // namespace spectral_conformal::python
