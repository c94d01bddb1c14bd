#pragma once

#include <optional>
#include <string>

namespace spectral_conformal {

// The BLAS to which CHOLMOD's calls are bound, and its number of threads.
//
// OpenBLAS has one number of threads for the whole process, and its order of summation depends on it. So that no result
// depends on a setting of the user, of NumPy or of another add-on, each call into CHOLMOD or BLAS is made under a
// BlasThreads, which fixes the number during that call and then restores it. Meanwhile other users of the same OpenBLAS
// run with our number too. (The setter for a single thread, openblas_set_num_threads_local, is missing from Debian 12's
// 0.3.21 and from the 0.3.34 of scipy-openblas32.) NumPy's wheels bring their own OpenBLAS, which is not affected.

/// The number of threads set for OpenBLAS in this process; empty with another BLAS, or without any.
std::optional<int> blas_thread_setting();
/// Changes that number for the whole process; no effect if there is none.
void set_blas_thread_setting(int threads);

/// Fixes OpenBLAS's number of threads at one while the object lives. The end of the last object, also by an exception,
/// restores the process's number, unless somebody else set another in between. Several threads may hold objects at
/// once; they wait for each other unless the BLAS serves many. A thread may hold several. No effect with another BLAS.
/// Why one: a second BLAS thread would spin while waiting, and stall if the other core is busy. A factorization
/// processes several subtrees in parallel instead (supernodal_factor.h).
class BlasThreads {
 public:
  BlasThreads();
  ~BlasThreads();
  BlasThreads(const BlasThreads&) = delete;
  BlasThreads& operator=(const BlasThreads&) = delete;
  /// Whether the BLAS has one setting for all threads of the process and may be called by several at once.
  static bool serves_many();

 private:
  [[maybe_unused]] bool is_alone_;  ///< holds the lock exclusively
};

/// The file and self-description of the BLAS to which the factorization's calls are bound, or "" without CHOLMOD.
std::string blas_library();
/// OpenBLAS's kernels, named by their target processor, such as "SkylakeX" for AVX-512; "" with another BLAS. Releases
/// older than a processor may select the kernels of a much older one.
std::string blas_kernel();

}  // namespace spectral_conformal
