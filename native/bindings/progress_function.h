#pragma once

#include <pybind11/pybind11.h>

#include "concurrency/listening.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal::python {

/// Calls a Python function, or nothing where it is None, with the GIL held; None and anything true go on. Python's
/// exceptions pass through, and Ctrl-C is noticed even where there is nothing to call. `callable` must outlive the
/// result.
Progress progress_of(const pybind11::object& callable);

/// Work of a call without the GIL: while it lives, the call's long work is heard by a progress function, or, with None,
/// by Ctrl-C alone.
class HeardWork {
 public:
  /// A handle, as an object that is made for the call ends after it, without the GIL.
  explicit HeardWork(const char* phase, pybind11::handle callable = Py_None)
      : callable_(pybind11::reinterpret_borrow<pybind11::object>(callable)),
        progress_(progress_of(callable_)),
        listening_(progress_, phase) {}

 private:
  pybind11::object callable_;
  Progress progress_;
  Listening listening_;
  pybind11::gil_scoped_release unlocked_;  ///< last, so that the GIL is held again before the others end
};

}  // namespace spectral_conformal::python
