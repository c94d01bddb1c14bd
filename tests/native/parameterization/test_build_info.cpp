#include <doctest/doctest.h>

#include "linear_algebra/factorization.h"
#include "spectral_conformal/build_info.h"

namespace spectral_conformal::test {

TEST_SUITE_BEGIN("build_info");

TEST_CASE("a build names its factorization, and the BLAS where that calls one") {
  const BuildInfo info = build_info();
  CHECK(info.factorization == factorization_library());
  CHECK(info.blas.empty() == (info.factorization.find("CHOLMOD") == std::string::npos));
  CHECK(info.kernel.empty() == (info.blas.find("OpenBLAS") == std::string::npos));
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
