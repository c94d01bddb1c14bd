#pragma once

#include <memory>
#include <string>

#include "linear_algebra/factorization.h"

namespace spectral_conformal {

/// Whether the module was built with CHOLMOD.
bool has_cholmod();

/// A supernodal L L^H with the order and structure found by SuiteSparse CHOLMOD (Chen, Davis, Hager and Rajamanickam,
/// Algorithm 887, 2008) and the numerical factorization of supernodal_factor.h. CHOLMOD's own processes the supernodes
/// one by one and stores complex numbers where all are real; its solve allocates memory and cannot stop at selected
/// vertices. Throws std::invalid_argument without CHOLMOD.
std::unique_ptr<Factorization> make_cholmod_factorization();

/// CHOLMOD's version, such as "3.0.14"; "" without it.
std::string cholmod_version_name();

}  // namespace spectral_conformal
