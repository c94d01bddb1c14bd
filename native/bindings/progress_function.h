#pragma once

#include <pybind11/pybind11.h>

#include "concurrency/cancellation_scope.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal::python {

/// Calls a Python function with the GIL held, or nothing if `callable` is None. The work continues unless the function
/// returns False. Python exceptions pass through, and Ctrl-C is noticed even without a function.
/// `callable` must outlive the result.
Progress progress_of(const pybind11::object& callable);

/// Long work without the GIL: while it lives, a progress function, or with None only Ctrl-C, can cancel the work of a
/// call.
class PolledWork {
 public:
  /// A handle, since an object created for the call would be destroyed after it, without the GIL.
  explicit PolledWork(const char* phase, pybind11::handle callable = Py_None)
      : callable_(pybind11::reinterpret_borrow<pybind11::object>(callable)),
        progress_(progress_of(callable_)),
        listening_(progress_, phase) {}

 private:
  pybind11::object callable_;
  Progress progress_;
  CancellationScope listening_;
  pybind11::gil_scoped_release unlocked_;  ///< last, so that the GIL is held again before the others are destroyed
};

}  // namespace spectral_conformal::python
