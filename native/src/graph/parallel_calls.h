#pragma once

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

}  // namespace spectral_conformal
