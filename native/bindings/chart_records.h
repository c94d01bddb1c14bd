#pragma once

#include <pybind11/pybind11.h>

#include <vector>

#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::python {

/// What spectral_conformal.Charts is made of: the rows of a structured array, one per chart, which takes a hundred
/// bytes where a Python object would take thousands; the faces of all charts, one chart after the other, of which each
/// row has the number; and what there is to say of a chart, UnwrappedChart::problem and steps_of, by its number. What
/// is used up of the charts is given back on the way.
pybind11::tuple chart_records(std::vector<UnwrappedChart>&& charts);

/// Adds the names of the rows' fields and codes to the module.
void bind_chart_records(pybind11::module_& module);

}  // namespace spectral_conformal::python
