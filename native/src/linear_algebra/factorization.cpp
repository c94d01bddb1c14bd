#include "linear_algebra/factorization.h"

#include <limits>

#include "concurrency/parallel_calls.h"
#include "linear_algebra/cholmod_factorization.h"
#include "linear_algebra/eigen_factorization.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {

HermitianMatrix lower_triangle(Eigen::Index n, const std::vector<Eigen::Triplet<Complex>>& entries) {
  HermitianMatrix result;
  call_while_polling(entries.size(), [&] {
    if (n < 1) return;
    result.resize(n, n);
    result.setFromTriplets(entries.begin(), entries.end());
  });
  return result;
}

void check_factor_size(double nonzeros) {
  // Both libraries index the entries of a factor by int here.
  if (nonzeros <= std::numeric_limits<int>::max()) return;
  throw SolveFailure(rejected(Rejection::too_large, std::numeric_limits<int>::max()));
}

std::unique_ptr<Factorization> make_factorization(FactorizationBackend backend, Eigen::Index n) {
  // For a smaller matrix, Eigen is faster than CHOLMOD's setup.
  constexpr Eigen::Index cholmod_from = 300;
  const bool is_better = has_cholmod() && n >= cholmod_from;
  if (backend == FactorizationBackend::cholmod || (backend == FactorizationBackend::automatic && is_better)) {
    return make_cholmod_factorization();
  }
  return make_eigen_factorization();
}

std::string factorization_library() {
  return has_cholmod() ? "CHOLMOD " + cholmod_version_name() : "Eigen " + eigen_version();
}

}  // namespace spectral_conformal
