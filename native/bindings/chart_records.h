#pragma once

#include <pybind11/pybind11.h>

#include <vector>

#include "spectral_conformal/unwrap.h"

namespace spectral_conformal::python {

/// The content of spectral_conformal.Charts: a structured array with one row per chart, of a hundred bytes where a
/// Python object takes thousands; the faces of all charts, one chart after another, with their number in each row; and
/// the steps of charts that have any, by chart number. Frees the memory of the charts as it goes.
pybind11::tuple chart_records(std::vector<UnwrappedChart>&& charts);

/// Adds the names of the row fields and codes to the module.
void bind_chart_records(pybind11::module_& module);

}  // namespace spectral_conformal::python
