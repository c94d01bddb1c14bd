#include <pybind11/pybind11.h>

#include "bindings/bind.h"
#include "linear_algebra/work_counts.h"
#include "spectral_conformal/build_info.h"
#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal::python {

namespace {

namespace py = pybind11;

py::dict info() {
  const BuildInfo build = build_info();
  return py::dict(py::arg("factorization") = build.factorization, py::arg("blas") = build.blas);
}

/// What the benchmarks' tests hold speed to; no part of the Python interface.
py::dict counts() {
  const WorkCounts sum = work_counts();
  return py::dict(py::arg("analyses") = sum.analyses, py::arg("factorizations") = sum.factorizations,
                  py::arg("solves") = sum.solves, py::arg("multiplications") = sum.multiplications,
                  py::arg("solve_doubles") = sum.solve_doubles);
}

}  // namespace

void bind_build(pybind11::module_& module) {
  module.def("build_info", &info);
  module.def("work_counts", &counts);
  module.attr("SIZE_LIMIT") = size_limit;
}

}  // namespace spectral_conformal::python
