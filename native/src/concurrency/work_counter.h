#pragma once

#include <cstdint>
#include <mutex>

namespace spectral_conformal {

/// What factorizations and searches cost: the same on every machine, however busy, for one SuiteSparse. The tests hold
/// the speed of the module as it ships to these.
struct WorkCounts {
  std::uint64_t analyses = 0;
  std::uint64_t factorizations = 0;
  std::uint64_t solves = 0;           ///< whole ones, or forward and backward parts of one
  std::uint64_t multiplications = 0;  ///< of supernodal factorizations, four for one of complex numbers
  std::uint64_t solve_doubles = 0;    ///< of supernodal factors, read in solves
  std::uint64_t steps = 0;            ///< corners, edges and list entries that the search for seams looks at
};

/// While it lives, it counts what is done by the thread that made it and by the threads that the library starts for
/// that one, in place of a counter that counted there before. Nothing that is computed depends on it.
class WorkCounter {
 public:
  WorkCounter() : share_(this) {}
  WorkCounter(const WorkCounter&) = delete;
  WorkCounter& operator=(const WorkCounter&) = delete;

  WorkCounts counts() const;
  void add(const WorkCounts& more);

  /// That of the calling thread, or null.
  static WorkCounter* current();
  /// Lets the calling thread count for a counter, or with null for none, while it lives.
  class Share {
   public:
    explicit Share(WorkCounter* counter);
    ~Share();
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

   private:
    WorkCounter* before_;
  };

 private:
  mutable std::mutex mutex_;
  WorkCounts counts_;
  Share share_;  ///< last: from then on it counts
};

/// For the calling thread's counter, if it has one.
void count_analysis();
void count_factorization(double multiplications);
void count_solve(double doubles);
void count_steps(double steps);

}  // namespace spectral_conformal
