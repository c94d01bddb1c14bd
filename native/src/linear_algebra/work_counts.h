#pragma once

#include <cstdint>

namespace spectral_conformal {

/// What factorisations have cost since the process began, in all threads: the same on every machine, however busy, for
/// one SuiteSparse. What the benchmarks' tests hold speed to.
struct WorkCounts {
  std::uint64_t analyses = 0;
  std::uint64_t factorizations = 0;
  std::uint64_t solves = 0;           ///< whole ones, or forward and backward parts of one
  std::uint64_t multiplications = 0;  ///< of supernodal factorisations, four for one of complex numbers
  std::uint64_t solve_doubles = 0;    ///< of supernodal factors, read in solves
};

WorkCounts work_counts();
void count_analysis();
void count_factorization(double multiplications);
void count_solve(double doubles);

}  // namespace spectral_conformal
