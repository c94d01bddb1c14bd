#include <pybind11/pybind11.h>

#include "bindings/bind.h"
#include "spectral_conformal/build_info.h"
#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal::python {

namespace {

namespace py = pybind11;

py::dict info() {
  const BuildInfo build = build_info();
  return py::dict(py::arg("factorization") = build.factorization, py::arg("blas") = build.blas);
}

}  // namespace

void bind_build(pybind11::module_& module) {
  module.def("build_info", &info);
  module.attr("SIZE_LIMIT") = size_limit;
}

}  // namespace spectral_conformal::python
