#pragma once

#include <pybind11/pybind11.h>

#include "bindings/options.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::python {

/// The fields of a record, by their Python names.
inline pybind11::dict solve_record(const SolveRecord& result) {
  pybind11::dict record;
  record["steps"] = steps_of(result.steps);
  record["eigenvalue"] = result.eigenvalue;
  record["eigenvalue_of"] = name_of(result.eigenvalue_of);
  record["residual"] = result.residual;
  record["iterations"] = result.iterations;
  record["attempts"] = result.attempts;
  record["turning_number"] = result.turning_number;
  record["method"] = name_of(result.method);
  record["weights"] = name_of(result.weights);
  record["boundary"] = name_of(result.boundary);
  record["fallback"] = name_of(result.fallback);
  record["clamped_triangles"] = result.clamped_triangles;
  record["relaxation"] = name_of(result.relaxation);
  record["scale_deviation_before"] = result.scale_deviation_before;
  record["scale_deviation"] = result.scale_deviation;
  record["unfolded"] = result.unfolded;
  record["hole_rigidity"] = result.hole_rigidity;
  record["polish_steps"] = result.polish_steps;
  record["is_embedding"] = result.is_embedding;
  record["mean_qc_before"] = result.mean_qc_before;
  return record;
}

}  // namespace spectral_conformal::python
