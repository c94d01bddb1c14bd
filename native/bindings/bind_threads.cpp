#include <pybind11/pybind11.h>

#include "bindings/bind.h"
#include "concurrency/cancellation_scope.h"
#include "concurrency/thread_budget.h"
#include "spectral_conformal/thread_limit.h"

namespace spectral_conformal::python {

void bind_threads(pybind11::module_& module) {
  module.def("limit_threads", &ThreadLimit::exchange);
  // For tests; not part of the Python interface.
  module.def("exchange_poll_interval", &exchange_poll_interval);
  module.def("pretend_cores", &ThreadBudget::exchange_cores);
}

}  // namespace spectral_conformal::python
