#pragma once

#include <cstddef>

#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// A block of columns of a Cholesky factor as one dense column-major matrix: L, (width, width) lower, and B, the rows
/// below it. Scalar is double or Complex.
template <class Scalar>
struct DenseBlock {
  int width;
  int height;
  Scalar* values;

  int below() const { return height - width; }
  Scalar* column(int j) const { return values + static_cast<std::ptrdiff_t>(j) * height; }
};

// The three steps of an elimination, by BLAS and LAPACK. Small blocks use our own loops: OpenBLAS locks a process-wide
// mutex in each call, and threads that factorize small matrices wait for it; two cores were no faster than one.

/// A = L L^H in place; for a small block also the next step. Returns false if A is not positive definite.
bool eliminate_columns(const DenseBlock<double>& block);
bool eliminate_columns(const DenseBlock<Complex>& block);

/// B <- B L^-H, unless eliminate_columns did it.
void divide_below(const DenseBlock<double>& block);
void divide_below(const DenseBlock<Complex>& block);

/// C = -B B^H, (below, below) lower.
void multiply_below(const DenseBlock<double>& block, double* c);
void multiply_below(const DenseBlock<Complex>& block, Complex* c);

/// b <- L^-1 b, (width,), and c <- c - B b, (below,).
void solve_lower(const DenseBlock<double>& block, Complex* b, Complex* c);
void solve_lower(const DenseBlock<Complex>& block, Complex* b, Complex* c);

/// b <- L^-H (b - B^H c).
void solve_upper(const DenseBlock<double>& block, Complex* b, const Complex* c);
void solve_upper(const DenseBlock<Complex>& block, Complex* b, const Complex* c);

}  // namespace spectral_conformal
