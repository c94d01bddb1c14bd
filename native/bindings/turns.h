#pragma once

#include <pybind11/pybind11.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

namespace spectral_conformal::python {

/// A progress function called the solver that called it, or one that waits for it.
struct Reentered {};

/// A factor has its own work space, so threads take turns. Waits without the GIL. A thread keeps its turn while its
/// progress function runs, which may call other solvers; a call that would wait for itself in the end is refused.
class Turns {
 public:
  class Turn {
   public:
    explicit Turn(Turns& turns) : turns_(turns) {
      const pybind11::gil_scoped_release unlocked;
      std::unique_lock<std::mutex> lock(mutex());
      while (turns.owner_ != std::thread::id()) {
        if (waits_for_this_thread(turns)) throw Reentered();
        waiting()[std::this_thread::get_id()] = &turns;
        ended().wait(lock);
        waiting().erase(std::this_thread::get_id());
      }
      turns.owner_ = std::this_thread::get_id();
    }
    ~Turn() {
      {
        const std::lock_guard<std::mutex> lock(mutex());
        turns_.owner_ = std::thread::id();
      }
      ended().notify_all();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    Turns& turns_;
  };

 private:
  // Of all solvers: who waits for whom concerns several.
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static std::condition_variable& ended() {
    static std::condition_variable ended;
    return ended;
  }
  static std::map<std::thread::id, Turns*>& waiting() {
    static std::map<std::thread::id, Turns*> waiting;
    return waiting;
  }
  /// Whether the thread whose turn it is, or the one for which that waits, and so on, is the calling one. Precondition:
  /// it is some thread's turn.
  static bool waits_for_this_thread(const Turns& turns) {
    std::thread::id owner = turns.owner_;
    while (owner != std::this_thread::get_id()) {
      const auto found = waiting().find(owner);
      if (found == waiting().end() || found->second->owner_ == std::thread::id()) return false;
      owner = found->second->owner_;
    }
    return true;
  }

  std::thread::id owner_;  ///< whose turn it is; none by default
};

}  // namespace spectral_conformal::python
