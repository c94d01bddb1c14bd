#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/seam_suggestion.h"
#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::python {

/// (vertex, u, v)
using PinList = std::vector<std::tuple<int, double, double>>;
/// (vertex, vertex, strength, half), see Extender
using ExtenderList = std::vector<std::tuple<int, int, double, double>>;

Pins pins_of(const PinList& list);
/// The members of LinearEquations.
using EquationArrays =
    std::tuple<std::vector<int>, std::vector<int>, std::vector<double>, std::vector<std::pair<int, double>>>;
LinearEquations equations_of(std::optional<EquationArrays>&& arrays);
std::vector<VertexExtender> extenders_of(const ExtenderList& list);

/// From a spectral_conformal.Options, whose values are already checked.
PatchOptions patch_options_of(const pybind11::object& options);
/// Likewise, without extenders.
SolveOptions solve_options_of(const pybind11::object& options);
/// From a spectral_conformal.SeamOptions, likewise.
SeamSuggestionOptions seam_options_of(const pybind11::object& options);

/// For each field of a record, the names of its values, each at the index given by code_of.
pybind11::dict names_of_codes();
/// Codes start at 0.
unsigned char code_of(Method method);
unsigned char code_of(Weights weights);
unsigned char code_of(BoundaryMeasure boundary);
unsigned char code_of(EigenvalueOf eigenvalue_of);
/// 0, named None, for Fallback::none.
unsigned char code_of(Fallback fallback);
/// 0, named None, without relaxation.
unsigned char code_of(std::optional<RelaxationStatus> relaxation);

const char* name_of(Method method);
const char* name_of(Weights weights);
const char* name_of(BoundaryMeasure boundary);
const char* name_of(EigenvalueOf eigenvalue_of);
/// None for Fallback::none.
pybind11::object name_of(Fallback fallback);
/// None without relaxation.
pybind11::object name_of(std::optional<RelaxationStatus> relaxation);

/// For each step the fields of a spectral_conformal.Step, in order.
pybind11::tuple steps_of(const std::vector<Step>& steps);

}  // namespace spectral_conformal::python
