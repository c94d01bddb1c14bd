#include "linear_algebra/work_counts.h"

#include <atomic>

namespace spectral_conformal {
namespace {

// Sums of the process; nothing that is computed depends on them.
std::atomic<std::uint64_t> counted_analyses{0};
std::atomic<std::uint64_t> counted_factorizations{0};
std::atomic<std::uint64_t> counted_solves{0};
std::atomic<std::uint64_t> counted_multiplications{0};
std::atomic<std::uint64_t> counted_solve_doubles{0};

void add(std::atomic<std::uint64_t>& sum, double value) {
  sum.fetch_add(static_cast<std::uint64_t>(value), std::memory_order_relaxed);
}

}  // namespace

WorkCounts work_counts() {
  return {counted_analyses, counted_factorizations, counted_solves, counted_multiplications, counted_solve_doubles};
}

void count_analysis() { add(counted_analyses, 1); }

void count_factorization(double multiplications) {
  add(counted_factorizations, 1);
  add(counted_multiplications, multiplications);
}

void count_solve(double doubles) {
  add(counted_solves, 1);
  add(counted_solve_doubles, doubles);
}

}  // namespace spectral_conformal
