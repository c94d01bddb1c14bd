#pragma once

namespace spectral_conformal {

/// While it lives, calls from the thread that created it use at most `limit` threads, including that thread. Limits
/// nest, and threads started by the library inherit the limit of their caller. Results do not depend on it.
class ThreadLimit {
 public:
  /// limit: 0 for the number of cores.
  explicit ThreadLimit(unsigned limit);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

  static unsigned current();  ///< of the calling thread; 0 for none
  /// Sets the limit of the calling thread and returns the previous one; for languages without destructors.
  static unsigned exchange(unsigned limit);
  /// How many threads a call may use: the limit, or this thread's share of the cores if that is smaller.
  static unsigned available();

 private:
  unsigned before_;
};

}  // namespace spectral_conformal
