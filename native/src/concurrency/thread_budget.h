#pragma once

#include <atomic>

namespace spectral_conformal {

/// Divides the cores among the threads of the process. Concurrent calls divide the cores. A call divides its part among
/// the threads that it starts; these divide theirs again when they share work of their own. A thread that ends, or
/// waits for its helpers, leaves its part to the threads that work for the same caller.
class ThreadBudget {
 public:
  /// How many threads a call from this thread may use, including this one: its part of the cores, or of its ThreadLimit
  /// if that is smaller.
  static unsigned available();
  /// Helpers at work in the whole process, not counting one for each thread that waits for its own.
  static unsigned n_helpers();

  /// For tests: while it lives, the process acts as if it had this many cores; 0 for the machine's.
  class Pretended {
   public:
    explicit Pretended(unsigned cores) : before_(exchange_cores(cores)) {}
    ~Pretended() { exchange_cores(before_); }
    Pretended(const Pretended&) = delete;
    Pretended& operator=(const Pretended&) = delete;

   private:
    unsigned before_;
  };
  /// The same until the next call. Returns the previous number.
  static unsigned exchange_cores(unsigned cores);
  static unsigned cores();

  /// The helpers of a thread while the object lives. The thread that created it must destroy it after joining the
  /// helpers, in reverse order of construction.
  class Share {
   public:
    /// wanted: the number of helpers; there may be fewer, or none.
    explicit Share(unsigned wanted);
    ~Share();
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    unsigned size() const { return size_; }
    /// Returns helpers that could not be started.
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
    /// While it lives, the owner only waits for its helpers.
    class Waiting {
     public:
      explicit Waiting(Share& share) : share_(share) { share_.leave(); }
      ~Waiting() { share_.rejoin(); }
      Waiting(const Waiting&) = delete;
      Waiting& operator=(const Waiting&) = delete;

     private:
      Share& share_;
    };

   private:
    friend class ThreadBudget;
    unsigned each() const;
    void leave();
    void rejoin();
    void give_back(unsigned n);

    Share* outer_ = nullptr;  ///< of which this thread has a part; null for a caller's own
    Share* caller_ = nullptr;
    unsigned total_ = 1;  ///< for the helpers and the thread that owns them
    unsigned size_ = 0;
    std::atomic<unsigned> at_work_{1};
    unsigned n_left_ = 0;  ///< of the helpers and the owner
    /// Helpers at work in all shares within the caller's, less the owners that wait: -1 if the last helper has left.
    int n_of_caller_ = 0;
  };
};

}  // namespace spectral_conformal
