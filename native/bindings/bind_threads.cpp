#include <pybind11/pybind11.h>

#include "bindings/bind.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal::python {

void bind_threads(pybind11::module_& module) { module.def("limit_threads", &ThreadLimit::exchange); }

}  // namespace spectral_conformal::python
