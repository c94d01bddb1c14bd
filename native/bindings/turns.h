#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <mutex>
#include <thread>

namespace spectral_conformal::python {

/// A progress function called the solver that called it.
struct Reentered {};

/// A factor has its own work space, so threads take turns. Waits without the GIL; the thread whose turn it is must not
/// reenter (from its progress function).
class Turns {
 public:
  class Turn {
   public:
    explicit Turn(Turns& turns) : turns_(turns) {
      if (turns.owner_ == std::this_thread::get_id()) {
        throw Reentered();
      }
      {
        const pybind11::gil_scoped_release unlocked;
        turns.mutex_.lock();
      }
      turns.owner_ = std::this_thread::get_id();
    }
    ~Turn() {
      turns_.owner_ = std::thread::id();
      turns_.mutex_.unlock();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    Turns& turns_;
  };

 private:
  std::mutex mutex_;
  std::atomic<std::thread::id> owner_{};
};

}  // namespace spectral_conformal::python
