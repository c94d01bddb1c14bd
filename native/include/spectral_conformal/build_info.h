#pragma once

#include <string>

namespace spectral_conformal {

/// What this build of the library solves with.
struct BuildInfo {
  std::string factorization;  ///< the library behind FactorizationBackend::automatic and its version
  std::string blas;           ///< the BLAS that the factorisation calls, its file and what it says of itself, or ""
  std::string kernel;         ///< the kernels that this BLAS runs on this processor, such as "SkylakeX", or ""
};

BuildInfo build_info();

}  // namespace spectral_conformal
