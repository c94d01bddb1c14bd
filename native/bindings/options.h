#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <tuple>
#include <vector>

#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::python {

/// (vertex, u, v)
using PinList = std::vector<std::tuple<int, double, double>>;
/// (vertex, vertex, strength)
using ExtenderList = std::vector<std::tuple<int, int, double>>;

Method method_named(const std::string& name);
const char* name_of(Method method);

Pins pins_of(const PinList& list);
std::vector<VertexExtender> extenders_of(const ExtenderList& list);

}  // namespace spectral_conformal::python
