#pragma once

namespace spectral_conformal {

/// While it lives, a call of the thread that made it uses at most `limit` threads, including its own. Limits nest, and
/// threads that the library starts inherit the limit of their caller. Results do not depend on it.
class ThreadLimit {
 public:
  /// limit: 0 for as many as the machine has cores.
  explicit ThreadLimit(unsigned limit);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

  static unsigned current();  ///< of the calling thread; 0 for none
  /// Sets the limit of the calling thread until it is set again, for languages without destructors; returns the one
  /// before.
  static unsigned exchange(unsigned limit);
  /// How many threads a call may use: the limit, or this thread's part of the cores if that is less.
  static unsigned available();

 private:
  unsigned before_;
};

}  // namespace spectral_conformal
