#pragma once

#include <Spectra/SymEigsSolver.h>

#include <stdexcept>

#include "conformal/eigenproblem.h"

namespace spectral_conformal {

/// Keeps an exception that an operator threw while Spectra ran: from the progress function, a factorization or a lack
/// of memory. Spectra reports its own failures as std::runtime_error, so the type cannot tell them apart.
class Interruption {
 public:
  template <class Function>
  void guard(const Function& function) {
    try {
      function();
    } catch (...) {
      happened_ = true;
      throw;
    }
  }
  bool happened() const { return happened_; }

 private:
  bool happened_ = false;
};

/// Runs Lanczos. Spectra throws std::runtime_error if its small projected matrix is not finite or does not converge; an
/// exception of the operator passes through.
template <class Solver, class Operator>
bool converges(Solver& solver, const Operator& op, const EigenproblemOptions& options) {
  try {
    solver.compute(Spectra::SortRule::LargestAlge, options.max_restarts, options.tolerance);
  } catch (const std::runtime_error&) {
    if (op.interrupted()) throw;
    return false;
  }
  return solver.info() == Spectra::CompInfo::Successful;
}

}  // namespace spectral_conformal
