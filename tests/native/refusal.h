#pragma once

#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {

/// The step of the InvalidMesh that a call throws; without one, a step whose reason is Rejection::none.
template <class Call>
Step refusal(const Call& call) {
  try {
    call();
  } catch (const InvalidMesh& problem) {
    return problem.step();
  }
  return {};
}

}  // namespace spectral_conformal::test
