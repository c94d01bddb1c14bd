#pragma once

#include <atomic>
#include <chrono>
#include <exception>

#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// While it lives, long work of the thread that made it is heard by a progress function also where it reports nothing
/// itself: `still_working` repeats the last report, and threads that work for this one hear of a cancellation there.
/// One within another takes its place.
class Listening {
 public:
  /// How often the listener is asked, by work or by time. Python's listeners wait up to 5 ms for its lock where another
  /// thread is busy.
  static constexpr std::chrono::milliseconds interval{40};

  /// progress: must outlive the object; where it is empty, nothing changes. phase: until the first report, with 0.
  Listening(const Progress& progress, const char* phase);
  ~Listening();
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

  /// To be reported to in place of the one that was given.
  const Progress& progress() const { return heard_; }

  /// Asks the listener of this thread now, if it has one. Throws Cancelled, or what the listener throws.
  static void ask();
  /// Whether this thread has a listener of its own.
  static bool has_listener();
  /// Whether that of this thread, or of the one that it works for, has ended the work.
  static bool is_cancelled();
  /// Throws what ended the work, if the listener of this thread has done that.
  static void rethrow();
  /// That of this thread, or of the one that it works for; null for none.
  static Listening* current();

  /// Lets the calling thread hear of another's cancellation while it lives.
  class Overheard {
   public:
    explicit Overheard(Listening* listening);
    ~Overheard();
    Overheard(const Overheard&) = delete;
    Overheard& operator=(const Overheard&) = delete;

   private:
    Listening* before_;
  };

 private:
  friend void still_working(double nanoseconds);
  bool hear(double fraction, const char* phase);
  void rethrow_own() const;

  const Progress* given_;
  Progress heard_;
  Listening* before_ = nullptr;
  double fraction_ = 0;
  const char* phase_;
  std::atomic<bool> is_cancelled_{false};
  std::exception_ptr thrown_;  ///< by the listener
};

/// For tests: another interval of work, in nanoseconds, for the threads that begin to listen from then on. Returns the
/// one before.
double exchange_listening_interval(double nanoseconds);

/// Says that this thread has worked for about so long since it said so last; after each Listening::interval of such
/// work the listener is asked. Costs little, and throws as Listening::ask does: to be called where nothing is left half
/// done.
void still_working(double nanoseconds);

}  // namespace spectral_conformal
