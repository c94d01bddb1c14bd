#include "parameterization/chart_loop.h"

#include <algorithm>
#include <new>
#include <numeric>
#include <optional>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"

namespace spectral_conformal {
namespace {

/// Larger charts parallelize their own factorization, and take too much memory for two at a time.
constexpr std::size_t max_faces_together = 20000;

/// The maps of a batch are kept until it ends, so its faces have a limit; its charts too, since even one of a single
/// face takes a kilobyte until then.
int end_of_batch(const std::vector<std::size_t>& n_faces, int first) {
  std::size_t sum = n_faces[first];
  int last = first + 1;
  if (sum > max_faces_together) return last;
  const int end = std::min(static_cast<int>(n_faces.size()), first + static_cast<int>(max_faces_together));
  while (last < end && n_faces[last] <= max_faces_together && sum + n_faces[last] <= 20 * max_faces_together) {
    sum += n_faces[last++];
  }
  return last;
}

/// Empty if memory is too small.
std::optional<ChartSolution> tried_solution(const ChartWork& work, int i, const Progress& progress) {
  try {
    return work.solve(i, progress);
  } catch (const std::bad_alloc&) {
    return std::nullopt;
  }
}

}  // namespace

void solve_charts(const std::vector<std::size_t>& n_faces, const Progress& progress, const ChartWork& work) {
  // The faces before each chart, and before the end.
  std::vector<double> before{0};
  for (const std::size_t n : n_faces) before.push_back(before.back() + static_cast<double>(n));
  const int n_charts = static_cast<int>(n_faces.size());
  int n_given_up = 0;
  for (int first = 0; first < n_charts;) {
    const int last = end_of_batch(n_faces, first);
    std::vector<std::optional<ChartSolution>> solutions(static_cast<std::size_t>(last - first));
    run_in_parallel(
        last - first,
        [&](int k, const Progress& charts_progress) {
          const int i = first + k;
          const Progress own = part(charts_progress, before[i] / before.back(), before[i + 1] / before.back());
          solutions[static_cast<std::size_t>(k)] = tried_solution(work, i, own);
        },
        progress, "eigenproblem", max_threads_for(20 * (before[last] - before[first])));
    const bool were_others = last - first > 1;
    // Progress must not fall.
    const double done = before[last] / before.back();
    const Progress rest = [&](double, const char* phase) { return !progress || progress(done, phase); };
    for (std::optional<ChartSolution>& solution : solutions) {
      if (!solution && were_others) solution = tried_solution(work, first, rest);
      if (!solution) {
        solution = work.give_up(first);
        ++n_given_up;
      }
      // This frees its memory.
      work.write(*std::exchange(solution, std::nullopt));
      ++first;
    }
  }
  if (n_given_up > 0 && n_given_up == n_charts) throw std::bad_alloc();
}

}  // namespace spectral_conformal
