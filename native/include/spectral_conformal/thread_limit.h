#pragma once

namespace spectral_conformal {

/// While it lives, calls made by the thread that made it share at most so many threads, that one among them; a thread's
/// limits nest, and threads that the library starts have that of the thread they work for. Results do not depend on it.
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
  static unsigned
  available();  ///< how many threads a call may share: the limit, or this thread's part of the cores if that is less

 private:
  unsigned before_;
};

}  // namespace spectral_conformal
