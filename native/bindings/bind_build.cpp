#include <pybind11/pybind11.h>

#include "bindings/bind.h"
#include "linear_algebra/blas_threads.h"
#include "linear_algebra/factorization.h"
#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal::python {

namespace {

namespace py = pybind11;

py::dict build_info() {
  return py::dict(py::arg("factorization") = factorization_library(), py::arg("blas") = blas_library());
}

}  // namespace

void bind_build(pybind11::module_& module) {
  module.def("build_info", &build_info);
  module.attr("SIZE_LIMIT") = size_limit;
}

}  // namespace spectral_conformal::python
