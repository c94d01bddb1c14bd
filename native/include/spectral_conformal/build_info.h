#pragma once

#include <string>

namespace spectral_conformal {

/// The numerical libraries of this build.
struct BuildInfo {
  std::string factorization;  ///< the library behind FactorizationBackend::automatic and its version
  std::string blas;           ///< the BLAS behind the factorization: its file and its self-description, or ""
  std::string kernel;         ///< the kernels that this BLAS selects on this processor, such as "SkylakeX", or ""
};

BuildInfo build_info();

}  // namespace spectral_conformal
