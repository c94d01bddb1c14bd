#include "linear_algebra/dense_kernels.h"

#ifdef SPECTRAL_CONFORMAL_HAVE_CHOLMOD

#include <cmath>

// BLAS and LAPACK, Fortran linkage.
extern "C" {
void dpotrf_(const char*, const int*, double*, const int*, int*);
void dtrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const double*, const double*,
            const int*, double*, const int*);
void dsyrk_(const char*, const char*, const int*, const int*, const double*, const double*, const int*, const double*,
            double*, const int*);
void zpotrf_(const char*, const int*, void*, const int*, int*);
void ztrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const void*, const void*,
            const int*, void*, const int*);
void zherk_(const char*, const char*, const int*, const int*, const double*, const void*, const int*, const double*,
            void*, const int*);
void ztrsv_(const char*, const char*, const char*, const int*, const void*, const int*, void*, const int*);
void zgemv_(const char*, const int*, const int*, const void*, const void*, const int*, const void*, const int*,
            const void*, void*, const int*);
}

namespace spectral_conformal {
namespace {

/// The address of a number while a call lasts: Fortran takes all arguments by address.
template <class Number>
const Number* by_address(const Number& number) {
  return &number;
}

/// Up to this many multiplications (width times height squared), a block is faster here than by BLAS calls.
constexpr double max_small_elimination = 8000;
/// The same for the columns in a solve.
constexpr int max_small_width = 24;

template <class Scalar>
bool is_small(const DenseBlock<Scalar>& block) {
  return static_cast<double>(block.width) * block.height * block.height <= max_small_elimination;
}

template <class Scalar>
using StridedMatrix = Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>, 0, Eigen::OuterStride<>>;

template <class Scalar>
bool eliminate_small_columns(const DenseBlock<Scalar>& block) {
  StridedMatrix<Scalar> a(block.values, block.height, block.width, Eigen::OuterStride<>(block.height));
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const double pivot = std::real(a(j, j));
    if (!(pivot > 0)) return false;
    const double root = std::sqrt(pivot);
    a(j, j) = root;
    const Eigen::Index below = a.rows() - j - 1;
    auto column = a.col(j).tail(below);
    column *= 1 / root;
    for (Eigen::Index k = j + 1; k < a.cols(); ++k) {
      a.col(k).tail(a.rows() - k) -= column.tail(a.rows() - k) * Eigen::numext::conj(a(k, j));
    }
  }
  return true;
}

template <class Scalar>
void multiply_small(const DenseBlock<Scalar>& block, Scalar* target) {
  const int n = block.below();
  const StridedMatrix<Scalar> b(block.values + block.width, n, block.width, Eigen::OuterStride<>(block.height));
  StridedMatrix<Scalar> c(target, n, n, Eigen::OuterStride<>(n));
  for (Eigen::Index j = 0; j < c.cols(); ++j) {
    auto column = c.col(j).tail(c.rows() - j);
    column.setZero();
    for (Eigen::Index k = 0; k < b.cols(); ++k) column -= b.col(k).tail(c.rows() - j) * Eigen::numext::conj(b(j, k));
  }
}

/// b <- L^-1 b, and b <- L^-H b.
void solve_small_lower(const DenseBlock<Complex>& block, Complex* b) {
  for (int j = 0; j < block.width; ++j) {
    const Complex* const l = block.column(j);
    b[j] /= l[j].real();
    const double re = b[j].real();
    const double im = b[j].imag();
    for (int i = j + 1; i < block.width; ++i) {
      b[i] -= Complex(l[i].real() * re - l[i].imag() * im, l[i].real() * im + l[i].imag() * re);
    }
  }
}
void solve_small_upper(const DenseBlock<Complex>& block, Complex* b) {
  for (int j = block.width - 1; j >= 0; --j) {
    const Complex* const l = block.column(j);
    double re = b[j].real();
    double im = b[j].imag();
    for (int i = j + 1; i < block.width; ++i) {
      re -= l[i].real() * b[i].real() + l[i].imag() * b[i].imag();
      im -= l[i].real() * b[i].imag() - l[i].imag() * b[i].real();
    }
    b[j] = Complex(re, im) / l[j].real();
  }
}

}  // namespace

bool eliminate_columns(const DenseBlock<double>& block) {
  if (is_small(block)) return eliminate_small_columns(block);
  int info = 0;
  dpotrf_("L", &block.width, block.values, &block.height, &info);
  return info == 0;
}
bool eliminate_columns(const DenseBlock<Complex>& block) {
  if (is_small(block)) return eliminate_small_columns(block);
  int info = 0;
  zpotrf_("L", &block.width, block.values, &block.height, &info);
  return info == 0;
}

void divide_below(const DenseBlock<double>& block) {
  if (is_small(block)) return;
  const int below = block.below();
  dtrsm_("R", "L", "T", "N", &below, &block.width, by_address(1.0), block.values, &block.height,
         block.values + block.width, &block.height);
}
void divide_below(const DenseBlock<Complex>& block) {
  if (is_small(block)) return;
  const int below = block.below();
  ztrsm_("R", "L", "C", "N", &below, &block.width, by_address(Complex(1)), block.values, &block.height,
         block.values + block.width, &block.height);
}

void multiply_below(const DenseBlock<double>& block, double* c) {
  if (is_small(block)) return multiply_small(block, c);
  const int below = block.below();
  dsyrk_("L", "N", &below, &block.width, by_address(-1.0), block.values + block.width, &block.height, by_address(0.0),
         c, &below);
}
void multiply_below(const DenseBlock<Complex>& block, Complex* c) {
  if (is_small(block)) return multiply_small(block, c);
  const int below = block.below();
  zherk_("L", "N", &below, &block.width, by_address(-1.0), block.values + block.width, &block.height, by_address(0.0),
         c, &below);
}

// Solves with a real block and a complex vector. BLAS has only real vectors for these and would read the block twice.

/// Four columns at a time: a quarter of the reads and writes of c.
void solve_lower(const DenseBlock<double>& block, Complex* b, Complex* c) {
  const int n = block.width;
  const int m = block.below();
  int j = 0;
  for (; j + 4 <= n; j += 4) {
    const double* const l[] = {block.column(j), block.column(j + 1), block.column(j + 2), block.column(j + 3)};
    for (int p = 0; p < 4; ++p) {
      b[j + p] /= l[p][j + p];
      for (int q = p + 1; q < 4; ++q) b[j + q] -= l[p][j + q] * b[j + p];
    }
    const Complex x[] = {b[j], b[j + 1], b[j + 2], b[j + 3]};
    for (int i = j + 4; i < n; ++i) b[i] -= (l[0][i] * x[0] + l[1][i] * x[1]) + (l[2][i] * x[2] + l[3][i] * x[3]);
    for (int i = 0; i < m; ++i) {
      const int row = n + i;
      c[i] -= (l[0][row] * x[0] + l[1][row] * x[1]) + (l[2][row] * x[2] + l[3][row] * x[3]);
    }
  }
  for (; j < n; ++j) {
    const double* const l = block.column(j);
    b[j] /= l[j];
    for (int i = j + 1; i < n; ++i) b[i] -= l[i] * b[j];
    for (int i = 0; i < m; ++i) c[i] -= l[n + i] * b[j];
  }
}
void solve_lower(const DenseBlock<Complex>& block, Complex* b, Complex* c) {
  const int below = block.below();
  if (block.width <= max_small_width) {
    solve_small_lower(block, b);
  } else {
    ztrsv_("L", "N", "N", &block.width, block.values, &block.height, b, by_address(1));
  }
  if (below == 0) return;
  zgemv_("N", &below, &block.width, by_address(Complex(-1)), block.values + block.width, &block.height, b,
         by_address(1), by_address(Complex(1)), c, by_address(1));
}

/// Four columns at a time, with independent sums.
void solve_upper(const DenseBlock<double>& block, Complex* b, const Complex* c) {
  const int n = block.width;
  const int m = block.below();
  int j = n;
  for (; j % 4 != 0; --j) {
    const double* const l = block.column(j - 1);
    Complex sum = 0;
    for (int i = j; i < n; ++i) sum += l[i] * b[i];
    for (int i = 0; i < m; ++i) sum += l[n + i] * c[i];
    b[j - 1] = (b[j - 1] - sum) / l[j - 1];
  }
  for (; j > 0; j -= 4) {
    const double* const l[] = {block.column(j - 4), block.column(j - 3), block.column(j - 2), block.column(j - 1)};
    Complex sum[4] = {};
    for (int i = j; i < n; ++i) {
      for (int p = 0; p < 4; ++p) sum[p] += l[p][i] * b[i];
    }
    for (int i = 0; i < m; ++i) {
      for (int p = 0; p < 4; ++p) sum[p] += l[p][n + i] * c[i];
    }
    for (int p = 3; p >= 0; --p) {
      const int at = j - 4 + p;
      for (int q = p + 1; q < 4; ++q) sum[p] += l[p][j - 4 + q] * b[j - 4 + q];
      b[at] = (b[at] - sum[p]) / l[p][at];
    }
  }
}
void solve_upper(const DenseBlock<Complex>& block, Complex* b, const Complex* c) {
  const int below = block.below();
  if (below > 0) {
    zgemv_("C", &below, &block.width, by_address(Complex(-1)), block.values + block.width, &block.height, c,
           by_address(1), by_address(Complex(1)), b, by_address(1));
  }
  if (block.width <= max_small_width) {
    solve_small_upper(block, b);
  } else {
    ztrsv_("L", "C", "N", &block.width, block.values, &block.height, b, by_address(1));
  }
}

}  // namespace spectral_conformal

#endif
