#include <doctest/doctest.h>

#include "linear_algebra/cholmod_factorization.h"
#include "linear_algebra/factorization.h"
#include "meshes.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal::test {
namespace {

ComplexVector product(const HermitianMatrix& matrix, const ComplexVector& z) {
  return matrix.selfadjointView<Eigen::Lower>() * z;
}

std::unique_ptr<Factorization> factor(const HermitianMatrix& matrix, FactorizationBackend backend) {
  auto result = make_factorization(backend, 1000);
  result->analyze(matrix);
  REQUIRE(result->factorize(matrix));
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("factorization");

TEST_CASE("every backend solves to 1e-12, and they agree") {
  for (const int size : {1, 7, 40}) {
    const HermitianMatrix matrix = shifted_energy(size);
    const ComplexVector expected = random_map(matrix.cols());
    for (const auto backend : backends()) {
      const auto factorization = factor(matrix, backend);
      ComplexVector x = product(matrix, expected);
      factorization->solve(x, x);  // in place
      CHECK(difference(x, expected) < 1e-12);
      CHECK(factorization->factor_nonzeros() >= static_cast<double>(matrix.nonZeros() - matrix.cols()));
    }
  }
}

TEST_CASE("entries of one place are summed up") {
  const HermitianMatrix matrix = lower_triangle(2, {{0, 0, 1.0}, {1, 0, Complex(0, 2)}, {0, 0, 3.0}, {1, 1, 1.0}});
  CHECK(matrix.nonZeros() == 3);
  CHECK(matrix.coeff(0, 0) == Complex(4));
  CHECK(matrix.coeff(1, 0) == Complex(0, 2));
  CHECK(lower_triangle(3, {}).rows() == 3);
  CHECK(lower_triangle(0, {}).rows() == 0);
}

TEST_CASE("solves on selected vertices are parts of the whole solve") {
  const HermitianMatrix matrix = shifted_energy(30);
  const int n = static_cast<int>(matrix.cols());
  for (const auto backend : backends()) {
    const auto factorization = factor(matrix, backend);
    for (const std::vector<int>& selected : {std::vector<int>{n / 2}, {n - 1, 0, 17, 5, 400}, {3, 4, 5, 6, 7, 8}}) {
      factorization->select(selected);
      const ComplexVector b = random_map(static_cast<Eigen::Index>(selected.size()), 3);
      ComplexVector whole = ComplexVector::Zero(n);
      for (std::size_t i = 0; i < selected.size(); ++i) whole[selected[i]] = b[i];
      ComplexVector expected;
      factorization->solve(whole, expected);
      ComplexVector from_selected;
      factorization->solve_from_selected(b, from_selected);
      CHECK(difference(from_selected, expected) < 1e-13);
      ComplexVector at_selected;
      factorization->solve_selected(b, at_selected);
      REQUIRE(at_selected.size() == b.size());
      for (std::size_t i = 0; i < selected.size(); ++i) {
        CHECK(std::abs(at_selected[i] - expected[selected[i]]) < 1e-13 * expected.norm());
      }
    }
  }
}

TEST_CASE("a matrix that is not positive definite is refused, and the same object factorizes the next one") {
  const HermitianMatrix good = shifted_energy(9);
  for (const double shift : {-1e3, -2.0}) {
    HermitianMatrix indefinite = good;
    for (int v = 0; v < good.cols(); v += 10) indefinite.coeffRef(v, v) += shift;
    for (const auto backend : backends()) {
      const auto factorization = make_factorization(backend, 1000);
      factorization->analyze(good);
      CHECK_FALSE(factorization->factorize(indefinite));
      REQUIRE(factorization->factorize(good));
      const ComplexVector expected = random_map(good.cols());
      ComplexVector x;
      factorization->solve(product(good, expected), x);
      CHECK(difference(x, expected) < 1e-12);
    }
  }
}

TEST_CASE("an object can be given a matrix of another structure") {
  for (const auto backend : backends()) {
    const auto factorization = factor(shifted_energy(20), backend);
    for (const int size : {4, 25}) {
      const HermitianMatrix matrix = shifted_energy(size);
      factorization->analyze(matrix);
      REQUIRE(factorization->factorize(matrix));
      const ComplexVector expected = random_map(matrix.cols());
      ComplexVector x;
      factorization->solve(product(matrix, expected), x);
      CHECK(difference(x, expected) < 1e-12);
    }
  }
}

TEST_CASE("a factor that ints cannot number is refused") {
  CHECK_NOTHROW(check_factor_size(2147483647.0));
  for (const double nonzeros : {2147483648.0, 1e12}) {
    CHECK_THROWS_AS(check_factor_size(nonzeros), SolveFailure);
  }
}

TEST_CASE("the library behind automatic is named") {
  const std::string library = factorization_library();
  CHECK(library.rfind(has_cholmod() ? "CHOLMOD " : "Eigen ", 0) == 0);
  CHECK(make_factorization(FactorizationBackend::automatic, 1000) != nullptr);
}

TEST_SUITE_END();

}  // namespace spectral_conformal::test
