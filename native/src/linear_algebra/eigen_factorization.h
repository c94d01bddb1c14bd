#pragma once

#include <memory>
#include <string>

#include "linear_algebra/factorization.h"

namespace spectral_conformal {

/// Eigen's SimplicialLDLT, ordered by AMD.
std::unique_ptr<Factorization> make_eigen_factorization();

/// Eigen's version, such as "3.4.0".
std::string eigen_version();

}  // namespace spectral_conformal
