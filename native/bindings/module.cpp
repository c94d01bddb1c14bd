#include <pybind11/pybind11.h>

#include "bindings/bind.h"

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
}
