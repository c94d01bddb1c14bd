#include <pybind11/pybind11.h>

#include "bindings/bind.h"

// Renames the function that pybind11 defines, which would wait forever in another interpreter: work without the GIL
// finds back to the main interpreter only.
#define PyInit__native PyInit_in_main_interpreter

PYBIND11_MODULE(_native, module) {
  using namespace spectral_conformal::python;
  bind_errors(module);
  bind_build(module);
  bind_parameterize(module);
  bind_charts(module);
  bind_unwrap(module);
  bind_quality(module);
  bind_metric(module);
  bind_seams(module);
  bind_threads(module);
  bind_packing(module);
  bind_island_packing(module);
  bind_relaxation(module);
  bind_rebake(module);
}

#undef PyInit__native

extern "C" PYBIND11_EXPORT PyObject* PyInit__native();
extern "C" PYBIND11_EXPORT PyObject* PyInit__native() {
  if (PyInterpreterState_Get() == PyInterpreterState_Main()) return PyInit_in_main_interpreter();
  PyErr_SetString(PyExc_ImportError, "spectral_conformal works in the main interpreter only; import it there.");
  return nullptr;
}
