#include <pybind11/pybind11.h>

#include "bindings/bind.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::python {

void bind_errors(pybind11::module_& module) {
  // Local to this module: a bundled copy and an installed one may be loaded side by side.
  pybind11::register_local_exception<InvalidMesh>(module, "InvalidMeshError", PyExc_ValueError);
  pybind11::register_local_exception<SolveFailure>(module, "SolveError", PyExc_RuntimeError);
  pybind11::register_local_exception<Cancelled>(module, "Cancelled", PyExc_Exception);
}

}  // namespace spectral_conformal::python
