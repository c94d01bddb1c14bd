#pragma once

#include <optional>
#include <string>

namespace spectral_conformal {

// The BLAS that CHOLMOD's calls are bound to, and its number of threads.
//
// OpenBLAS keeps one number of threads for the whole process, and sums in another order with another number. So that no
// result depends on a setting of the user, of NumPy or of another add-on, each call into CHOLMOD or BLAS is made under
// a BlasThreads, which fixes the number for the length of that call and then puts the process's own back. For that
// moment other users of the same OpenBLAS run with our number as well. (Its setter for one thread alone,
// openblas_set_num_threads_local, is in neither Debian 12's 0.3.21 nor the 0.3.34 of scipy-openblas32.) NumPy's wheels
// bring an OpenBLAS of their own, which is not touched.

/// The number of threads that the process has set for OpenBLAS; none with another BLAS, or where none is linked.
std::optional<int> blas_thread_setting();
/// Changes it, for the whole process; without effect where there is none.
void set_blas_thread_setting(int threads);

/// Fixes OpenBLAS's number of threads at one while the object lives, and puts the process's own number back when the
/// last of them ends, however it ends; a number that somebody else set in between is kept. May be held by several
/// threads at once, which wait for each other unless the BLAS serves many. A thread may hold several.
/// Without effect with another BLAS. A second thread of the BLAS itself would spin while it waits and stall where the
/// other core is busy; a factorization works on several subtrees at once instead (supernodal_factor.h).
class BlasThreads {
 public:
  BlasThreads();
  ~BlasThreads();
  BlasThreads(const BlasThreads&) = delete;
  BlasThreads& operator=(const BlasThreads&) = delete;
  /// Whether the BLAS keeps one setting for all threads of the process, and may be called by several of them at once.
  static bool serves_many();

 private:
  [[maybe_unused]] bool is_alone_;  ///< holds the lock alone
};

/// The file of the BLAS that the factorization's calls are bound to and what it says of itself, or "" without CHOLMOD.
std::string blas_library();
/// The kernels that OpenBLAS runs, by the processor that they are written for, such as "SkylakeX" for AVX-512; "" with
/// another BLAS. Releases older than a processor may run those of a much older one.
std::string blas_kernel();

}  // namespace spectral_conformal
