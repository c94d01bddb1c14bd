#pragma once

#include <memory>
#include <string>

#include "linear_algebra/factorization.h"

namespace spectral_conformal {

/// Whether the module was built with CHOLMOD.
bool has_cholmod();

/// SuiteSparse CHOLMOD's supernodal L L^H (Chen, Davis, Hager and Rajamanickam, Algorithm 887, 2008), whose blocks the
/// solves go through by BLAS themselves: CHOLMOD's own solve allocates, and cannot stop at selected vertices. Throws
/// std::invalid_argument without CHOLMOD.
std::unique_ptr<Factorization> make_cholmod_factorization();

/// CHOLMOD's version, such as "3.0.14"; "" without it.
std::string cholmod_version_name();

}  // namespace spectral_conformal
