#include <pybind11/pybind11.h>

#include "bindings/bind.h"
#include "concurrency/work_counter.h"
#include "spectral_conformal/build_info.h"
#include "spectral_conformal/polygon_mesh.h"

namespace spectral_conformal::python {

namespace {

namespace py = pybind11;

py::dict info() {
  const BuildInfo build = build_info();
  return py::dict(py::arg("factorization") = build.factorization, py::arg("blas") = build.blas,
                  py::arg("kernel") = build.kernel);
}

/// The cost of a function call in operations, which tests bound. Not part of the Python interface.
py::dict counted_work(const py::function& call) {
  const WorkCounter counter;
  call();
  const WorkCounts sum = counter.counts();
  return py::dict(py::arg("analyses") = sum.analyses, py::arg("factorizations") = sum.factorizations,
                  py::arg("solves") = sum.solves, py::arg("multiplications") = sum.multiplications,
                  py::arg("solve_doubles") = sum.solve_doubles, py::arg("steps") = sum.steps);
}

}  // namespace

void bind_build(pybind11::module_& module) {
  module.def("build_info", &info);
  module.def("counted_work", &counted_work);
  module.attr("SIZE_LIMIT") = size_limit;
  module.attr("VERSION") = SPECTRAL_CONFORMAL_VERSION;
}

}  // namespace spectral_conformal::python
