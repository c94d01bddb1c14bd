#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <initializer_list>
#include <utility>

#include "bindings/bind.h"
#include "bindings/options.h"

namespace spectral_conformal::python {

namespace {

namespace py = pybind11;

template <class T>
T named(const std::string& name, std::initializer_list<std::pair<const char*, T>> choices, const char* what) {
  std::string list;
  for (const auto& [key, value] : choices) {
    if (name == key) return value;
    list += std::string(list.empty() ? "'" : ", '") + key + "'";
  }
  throw py::value_error(std::string(what) + " must be one of " + list + ", not '" + name + "'.");
}

constexpr std::initializer_list<std::pair<const char*, Method>> methods = {
    {"spectral", Method::spectral}, {"lscm", Method::lscm}, {"fiedler", Method::fiedler}, {"area", Method::area}};

Method method_named(const std::string& name) { return named<Method>(name, methods, "method"); }

const char* name_of(Method method) {
  for (const auto& [name, value] : methods) {
    if (value == method) return name;
  }
  return "";
}

Weights weights_named(const std::string& name) {
  return named<Weights>(name, {{"uniform", Weights::uniform}, {"inverse_area", Weights::inverse_area}}, "weights");
}

BoundaryMeasure boundary_named(const std::string& name) {
  return named<BoundaryMeasure>(name, {{"length", BoundaryMeasure::length}, {"vertex", BoundaryMeasure::vertex}},
                                "boundary");
}

FactorizationBackend backend_named(const std::string& name) {
  return named<FactorizationBackend>(name,
                                     {{"auto", FactorizationBackend::automatic},
                                      {"cholmod", FactorizationBackend::cholmod},
                                      {"eigen", FactorizationBackend::eigen}},
                                     "factorization");
}

PatchOptions patch_options(const std::string& weights, const std::string& boundary, const std::string& backend,
                           bool fill_holes, double area_blend, bool fold_free) {
  return {weights_named(weights), boundary_named(boundary), backend_named(backend), fill_holes, area_blend, fold_free};
}

}  // namespace

Pins pins_of(const PinList& list) {
  Pins pins;
  for (const auto& [vertex, u, v] : list) pins[vertex] = Complex(u, v);
  return pins;
}

std::vector<VertexExtender> extenders_of(const ExtenderList& list) {
  std::vector<VertexExtender> extenders;
  for (const auto& [from, to, strength] : list) extenders.push_back({from, to, strength});
  return extenders;
}

void bind_options(pybind11::module_& module) {
  py::class_<PatchOptions>(module, "PatchOptions", py::module_local()).def(py::init(&patch_options));
}

}  // namespace spectral_conformal::python
