#pragma once

#include <cstdint>
#include <mutex>

namespace spectral_conformal {

/// The cost of factorizations and searches in operations: for a given SuiteSparse the same on every machine, however
/// busy. The tests bound these counts for the module as shipped.
struct WorkCounts {
  std::uint64_t analyses = 0;
  std::uint64_t factorizations = 0;
  std::uint64_t solves = 0;           ///< whole solves, or forward and backward parts of one
  std::uint64_t multiplications = 0;  ///< of supernodal factorizations; a complex one counts as four
  std::uint64_t solve_doubles = 0;    ///< read from supernodal factors in solves
  std::uint64_t steps = 0;            ///< corners and edges visited by the seam search; edges, boxes, words by packing;
                                      ///< samples by rebaking
};

/// While it lives, it counts the work of the thread that created it and of the threads that the library starts for that
/// thread, replacing an earlier counter. No result depends on it.
class WorkCounter {
 public:
  WorkCounter() : share_(this) {}
  WorkCounter(const WorkCounter&) = delete;
  WorkCounter& operator=(const WorkCounter&) = delete;

  WorkCounts counts() const;
  void add(const WorkCounts& more);

  /// The counter of the calling thread, or null.
  static WorkCounter* current();
  /// While it lives, the calling thread counts for the given counter, or for none if null.
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
  Share share_;  ///< last: counting starts here
};

/// These add to the calling thread's counter, if any.
void count_analysis();
void count_factorization(double multiplications);
void count_solve(double doubles);
void count_steps(double steps);

}  // namespace spectral_conformal
