#include "spectral_conformal/build_info.h"

#include "linear_algebra/blas_threads.h"
#include "linear_algebra/factorization.h"

namespace spectral_conformal {

BuildInfo build_info() { return {factorization_library(), blas_library(), blas_kernel()}; }

}  // namespace spectral_conformal
