#pragma once

#include <pybind11/pybind11.h>

#include "spectral_conformal/progress.h"

namespace spectral_conformal::python {

/// Calls a Python function, or nothing where it is None, with the GIL held; None and anything true go on. Python's
/// exceptions pass through, and Ctrl-C is noticed even where there is nothing to call. `callable` must outlive the
/// result.
Progress progress_of(const pybind11::object& callable);

}  // namespace spectral_conformal::python
