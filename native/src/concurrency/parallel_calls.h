#pragma once

#include <algorithm>
#include <functional>
#include <limits>

#include "concurrency/cancellation_scope.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

constexpr unsigned all_threads = std::numeric_limits<unsigned>::max();

/// Searches make this many tries at a time whatever the number of threads, so that results do not depend on it. Common
/// machines have as many cores; a try can take hundreds of megabytes on a large mesh.
constexpr int tries_at_once = 4;

/// How many threads so many steps (see poll) justify.
inline unsigned max_threads_for(double steps) { return steps < 2.0 * shared_steps ? 1 : all_threads; }

/// Calls work(i, progress) once for every i from 0 to n - 1, in as many threads as the caller's share of the
/// ThreadBudget allows, at most max_threads including the caller's. The calls must be independent. `progress` is called
/// only in the caller's thread, also while that waits for the others, with fractions that never fall. Once it returns
/// false or throws, it is not called again, and the progress function passed to the work stops all threads. If
/// `progress` is empty, the caller's CancellationScope is asked instead. Throws Cancelled or what `progress` threw;
/// otherwise what the first failed call threw.
void run_in_parallel(int n, const std::function<void(int i, const Progress& progress)>& work, const Progress& progress,
                     const char* phase_of_waiting, unsigned max_threads = all_threads);

/// Makes a long call that does not poll, such as one into another library. It runs in a helper thread while the
/// caller's thread asks its CancellationScope, or in the caller's thread if the call is short, nobody listens or the
/// ThreadBudget has no thread left. steps: of the call, see poll. Waits for the end of the call even after a
/// cancellation. Throws what the listener or the call throws.
void call_while_polling(std::size_t steps, const std::function<void()>& call);

/// Calls work(begin, end) once for every block of the numbers from 0 to n - 1, as run_in_parallel does; a single block
/// runs in the caller's thread. block_size: as many as make about shared_steps, but at least 1; results must not depend
/// on it. The caller's CancellationScope is asked between blocks.
template <class Index, class Work>
void run_blocks_in_parallel(Index n, Index block_size, const Work& work) {
  if (n <= 0) return;
  const auto work_on = [&](Index begin, Index end) {
    work(begin, end);
    poll(shared_steps * static_cast<std::size_t>(end - begin) / static_cast<std::size_t>(block_size));
  };
  if (n <= block_size) return work_on(0, n);
  run_in_parallel(
      static_cast<int>((n + block_size - 1) / block_size),
      [&](int block, const Progress&) {
        const Index begin = static_cast<Index>(block) * block_size;
        work_on(begin, std::min<Index>(n, begin + block_size));
      },
      {}, "");
}
/// The same where each number takes a step.
template <class Index, class Work>
void run_blocks_in_parallel(Index n, const Work& work) {
  run_blocks_in_parallel(n, static_cast<Index>(shared_steps), work);
}

}  // namespace spectral_conformal
