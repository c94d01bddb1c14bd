#pragma once

#include <algorithm>
#include <functional>

#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// Calls work(i, progress) once for every i from 0 to n - 1, in as many threads as the machine has cores or the
/// caller's ThreadLimit allows, at most max_threads, the caller's among them. The calls must not depend on each other.
/// `progress` is called in the caller's thread only, with fractions that never fall, also while it waits for the
/// others, and not again once it returned false or threw; the one that the work gets tells all threads then. Throws
/// Cancelled then, or what it threw, and otherwise what the first of the calls that failed has thrown.
void run_in_parallel(int n, unsigned max_threads, const std::function<void(int i, const Progress& progress)>& work,
                     const Progress& progress, const char* phase_of_waiting);

/// Calls work(begin, end) once for every block of block_size of the numbers from 0 to n - 1, the last one's may be
/// fewer, as run_in_parallel does; where there is one block, in the caller's thread. Index is an integer type that
/// holds n + block_size, and the number of blocks fits an int.
template <class Index, class Work>
void run_blocks_in_parallel(Index n, Index block_size, unsigned max_threads, const Work& work) {
  if (n <= 0) return;
  if (n <= block_size) {
    work(Index{0}, n);
    return;
  }
  run_in_parallel(
      static_cast<int>((n + block_size - 1) / block_size), max_threads,
      [&](int block, const Progress&) {
        const Index begin = static_cast<Index>(block) * block_size;
        work(begin, std::min<Index>(n, begin + block_size));
      },
      {}, "");
}

}  // namespace spectral_conformal
