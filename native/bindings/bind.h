#pragma once

#include <pybind11/pybind11.h>

namespace spectral_conformal::python {

// One function per area of the module; bind_<area>.cpp defines it. They only convert arguments and results: validation
// and its messages are in the Python facade (native/python), everything else in the library.
void bind_errors(pybind11::module_& module);
void bind_build(pybind11::module_& module);
void bind_parameterize(pybind11::module_& module);
void bind_charts(pybind11::module_& module);
void bind_unwrap(pybind11::module_& module);
void bind_quality(pybind11::module_& module);
void bind_metric(pybind11::module_& module);
void bind_seams(pybind11::module_& module);
void bind_threads(pybind11::module_& module);
void bind_packing(pybind11::module_& module);
void bind_island_packing(pybind11::module_& module);
void bind_relaxation(pybind11::module_& module);
void bind_rebake(pybind11::module_& module);

}  // namespace spectral_conformal::python
