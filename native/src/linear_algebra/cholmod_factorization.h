#pragma once

#include <memory>
#include <string>

#include "linear_algebra/factorization.h"

namespace spectral_conformal {

/// Whether the module was built with CHOLMOD.
bool has_cholmod();

/// A supernodal L L^H whose order and structure SuiteSparse CHOLMOD finds (Chen, Davis, Hager and Rajamanickam,
/// Algorithm 887, 2008), and whose numbers are supernodal_factor.h: CHOLMOD's own factorization goes through the
/// supernodes one after the other and keeps complex numbers where all are real, its solve allocates and cannot stop at
/// selected vertices. Throws std::invalid_argument without CHOLMOD.
std::unique_ptr<Factorization> make_cholmod_factorization();

/// CHOLMOD's version, such as "3.0.14"; "" without it.
std::string cholmod_version_name();

}  // namespace spectral_conformal
