#pragma once

#include <atomic>

namespace spectral_conformal {

/// The threads that the process may have at work: as many as there are cores. What a call shares its work among is
/// divided among the threads that it begins, and again where these share calls of their own; several calls at once
/// divide the cores. Threads that have ended leave their part to those that work for the same caller.
class ThreadBudget {
 public:
  /// How many threads a call of this thread may share, this one among them: its part of the cores, or of its
  /// ThreadLimit if that is less.
  static unsigned available();
  /// Threads that were begun and not yet joined, in the whole process.
  static unsigned n_helpers();

  /// For tests: while it lives, the process is taken to have so many cores; 0 for those of the machine.
  class Pretended {
   public:
    explicit Pretended(unsigned cores) : before_(exchange_cores(cores)) {}
    ~Pretended() { exchange_cores(before_); }
    Pretended(const Pretended&) = delete;
    Pretended& operator=(const Pretended&) = delete;

   private:
    unsigned before_;
  };
  /// The same until it is set again. Returns what was pretended before.
  static unsigned exchange_cores(unsigned cores);
  static unsigned cores();

  /// The helpers of a thread, which belong to it while the object lives. To be destroyed by the thread that made it,
  /// in the order opposite to that of construction, after the helpers were joined.
  class Share {
   public:
    /// wanted: helpers; there may be fewer, or none.
    explicit Share(unsigned wanted);
    ~Share();
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    unsigned size() const { return size_; }
    /// Gives helpers back that could not be begun.
    void shrink(unsigned size);

    /// Held by each helper while it works.
    class Member {
     public:
      explicit Member(Share& share);
      ~Member();
      Member(const Member&) = delete;
      Member& operator=(const Member&) = delete;

     private:
      Share& share_;
    };

   private:
    friend class ThreadBudget;
    unsigned each() const;
    void give_back(unsigned n);

    Share* outer_ = nullptr;  ///< that this thread has a part of; null for a caller's own
    Share* caller_ = nullptr;
    unsigned total_ = 1;  ///< for the helpers and the thread that has them
    unsigned size_ = 0;
    std::atomic<unsigned> at_work_{1};
    unsigned n_of_caller_ = 0;  ///< helpers in all shares within the caller's
  };
};

}  // namespace spectral_conformal
