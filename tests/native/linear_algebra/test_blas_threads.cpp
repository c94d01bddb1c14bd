#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "linear_algebra/blas_threads.h"
#include "linear_algebra/factorization.h"
#include "meshes.h"
#include "spectral_conformal/errors.h"
#include "spectral_conformal/parameterize.h"

namespace spectral_conformal::test {
namespace {

/// Another number than any that the library sets, while a test runs.
class Setting {
 public:
  static constexpr int number = 3;
  Setting() : before_(blas_thread_setting()) { set_blas_thread_setting(number); }
  ~Setting() {
    if (before_) set_blas_thread_setting(*before_);
  }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;
  /// Whether there is a setting at all: otherwise everything below must only do no harm.
  bool exists() const { return before_.has_value(); }
  /// Whether the process has `threads` now.
  bool is(int threads) const {
    return blas_thread_setting() == (exists() ? std::optional<int>(threads) : std::nullopt);
  }

 private:
  std::optional<int> before_;
};

}  // namespace

TEST_SUITE_BEGIN("blas_threads");

TEST_CASE("there is a setting where OpenBLAS serves CHOLMOD") {
  CHECK(blas_thread_setting().has_value() == (blas_library().find("OpenBLAS") != std::string::npos));
}

TEST_CASE("the number is one while it is held, and put back however that ends") {
  const Setting process;
  {
    const BlasThreads threads;
    CHECK(process.is(1));
  }
  CHECK(process.is(Setting::number));
  const auto hold_and_throw = [] {
    const BlasThreads threads;
    throw std::runtime_error("a failed solve");
  };
  CHECK_THROWS_AS(hold_and_throw(), std::runtime_error);
  CHECK(process.is(Setting::number));
}

TEST_CASE("a number that somebody else sets in between is kept") {
  const Setting process;
  {
    const BlasThreads threads;
    set_blas_thread_setting(4);
  }
  CHECK(process.is(4));
}

TEST_CASE("holders in two threads do not take each other's number for the process's") {
  const Setting process;
  std::atomic<int> wrong{0};
  const auto hold = [&] {
    for (int k = 0; k < 200; ++k) {
      const BlasThreads threads;
      if (!process.is(1)) ++wrong;
      std::this_thread::yield();
      if (!process.is(1)) ++wrong;
    }
  };
  std::thread first(hold);
  std::thread second(hold);
  first.join();
  second.join();
  CHECK(wrong == 0);
  std::thread reader([&] { CHECK(process.is(Setting::number)); });
  reader.join();
}

TEST_CASE("factorizations and solves leave the process's number alone, and do not depend on it") {
  const HermitianMatrix matrix = shifted_energy(25);
  HermitianMatrix indefinite = matrix;
  indefinite.coeffRef(7, 7) = -1;
  const ComplexVector b = random_map(matrix.cols());
  for (const auto backend : backends()) {
    ComplexVector expected;
    for (const int number : {1, 2, 3}) {
      const Setting process;
      set_blas_thread_setting(number);
      const auto factorization = make_factorization(backend, 1000);
      factorization->analyze(matrix);
      CHECK_FALSE(factorization->factorize(indefinite));
      CHECK(process.is(number));
      REQUIRE(factorization->factorize(matrix));
      CHECK(process.is(number));
      ComplexVector x;
      factorization->solve(b, x);
      CHECK(process.is(number));
      if (number == 1) expected = x;
      CHECK(x == expected);
      factorization->select({3, 4, 5});
      ComplexVector few;
      factorization->solve_selected(b.head(3), few);
      factorization->solve_from_selected(b.head(3), x);
      CHECK(process.is(number));
    }
  }
}

TEST_CASE("a solve that is cancelled, wherever, leaves the process's number alone; so do two at once") {
  const Setting process;
  const Patch patch(bumpy_grid(20, 18));
  int reports = 0;
  Solver::of(patch.chart, patch.positions, {}).solve({}, {}, [&](double, const char*) { return ++reports > 0; });
  REQUIRE(reports > 2);
  const auto cancel_everywhere = [&] {
    for (int stop = 1; stop <= reports; ++stop) {
      int left = stop;
      Solver solver = Solver::of(patch.chart, patch.positions, {});
      CHECK_THROWS_AS(solver.solve({}, {}, [&](double, const char*) { return --left > 0; }), Cancelled);
    }
  };
  cancel_everywhere();
  CHECK(process.is(Setting::number));
  std::thread first(cancel_everywhere);
  std::thread second(cancel_everywhere);
  first.join();
  second.join();
  CHECK(process.is(Setting::number));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
