#include "conformal/affine_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "graph/adjacency.h"
#include "graph/numbering.h"

namespace spectral_conformal {
namespace {

using Expansion = LinearConstraints::Expansion;

/// The coordinate along each axis that belongs to a vertex alone, by its number among all of the constraints, or -1.
using OwnCoordinates = std::vector<std::array<int, 2>>;

OwnCoordinates own_coordinates(const LinearConstraints& constraints) {
  std::vector<int> uses(static_cast<std::size_t>(constraints.n_unknowns()));
  for (int c = 0; c < constraints.expansion().rows(); ++c) {
    for (Expansion::InnerIterator it(constraints.expansion(), c); it; ++it) ++uses[it.col()];
  }
  OwnCoordinates result(static_cast<std::size_t>(constraints.n_vertices()), {no_index, no_index});
  for (int k = 0; k < constraints.n_unknowns(); ++k) {
    const int coordinate = constraints.coordinates()[k];
    if (uses[k] == 1 && coordinate / 2 < constraints.n_vertices()) result[coordinate / 2][coordinate % 2] = k;
  }
  return result;
}

/// Whether every vertex is free or held: each unknown is then one coordinate, and belongs to a pair.
bool leaves_vertices_whole(const LinearConstraints& constraints) {
  const std::vector<int>& coordinates = constraints.coordinates();
  if (constraints.expansion().nonZeros() != constraints.n_unknowns() || coordinates.size() % 2 != 0) return false;
  for (std::size_t k = 0; k < coordinates.size(); k += 2) {
    if (coordinates[k] % 2 != 0 || coordinates[k + 1] != coordinates[k] + 1) return false;
  }
  return true;
}

/// Whether the energy couples u and v of such coordinates. Where all of the border is constrained, it does not.
bool couples_axes(const HermitianMatrix& matrix, const OwnCoordinates& own) {
  const auto has_each = [&](int i, int j) { return own[i][0] != no_index && own[j][1] != no_index; };
  for (int j = 0; j < matrix.outerSize(); ++j) {
    for (HermitianMatrix::InnerIterator it(matrix, j); it; ++it) {
      const int i = static_cast<int>(it.row());
      if (it.value().imag() != 0 && (has_each(i, j) || has_each(j, i))) return true;
    }
  }
  return false;
}

/// The block of some rows and columns, in their order. row: of each, or -1.
HermitianMatrix block_of(const HermitianMatrix& matrix, const std::vector<int>& row, int n_rows) {
  HermitianMatrix block(n_rows, n_rows);
  block.reserve(matrix.nonZeros());
  for (int column = 0; column < matrix.outerSize(); ++column) {
    if (row[column] < 0) continue;
    block.startVec(row[column]);
    for (HermitianMatrix::InnerIterator it(matrix, column); it; ++it) {
      if (row[it.row()] >= 0) block.insertBack(row[it.row()], row[column]) = it.value();
    }
  }
  block.finalize();
  return block;
}

}  // namespace

AffineSpace AffineSpace::of(LinearConstraints constraints, const HermitianMatrix& matrix, const Positions& positions,
                            const Factorization& factorization) {
  AffineSpace result;
  result.adopt(std::move(constraints));
  const LinearConstraints& given = result.constraints_;
  result.n_vertices_ = given.n_vertices();
  result.is_complex_ = leaves_vertices_whole(given);
  if (!result.is_complex_) {
    result.choose_unknowns(matrix, positions, factorization);
    return result;
  }
  for (std::size_t k = 0; k < given.coordinates().size(); k += 2) result.add_unknown(false, given.coordinates()[k] / 2);
  return result;
}

AffineSpace AffineSpace::free(int n_vertices) {
  AffineSpace result;
  result.n_vertices_ = n_vertices;
  result.is_real_.assign(static_cast<std::size_t>(n_vertices), 0);
  result.vertex_.resize(static_cast<std::size_t>(n_vertices));
  std::iota(result.vertex_.begin(), result.vertex_.end(), 0);
  return result;
}

void AffineSpace::choose_unknowns(const HermitianMatrix& matrix, const Positions& positions,
                                  const Factorization& factorization) {
  const OwnCoordinates own = own_coordinates(constraints_);
  const int n_coordinates = constraints_.n_unknowns();
  int n_own = 0;
  int n_free = 0;  // of vertices that have both
  for (const auto& each : own) {
    const int n = (each[0] != no_index ? 1 : 0) + (each[1] != no_index ? 1 : 0);
    n_own += n;
    if (n == 2) n_free += n;
  }
  // The unknowns eliminated last are one dense block. A separator of a surface has about sqrt(V) vertices; beyond four
  // times as many, the complex part saves less than the block costs (on sheets with 1 to 4 straight sides).
  constexpr double max_separators = 4;
  const auto leaves_few = [&](int n) {
    return n_coordinates - n <= max_separators * std::sqrt(static_cast<double>(n_vertices_));
  };
  const bool is_mixed = leaves_few(n_free) && couples_axes(matrix, own);
  std::vector<int> unknown(static_cast<std::size_t>(n_coordinates), no_index);
  std::vector<char> is_imaginary(unknown.size(), 0);  // whether the coordinate is the imaginary part of its unknown
  const auto add_real = [&](int k) {
    unknown[k] = size();
    const int vertex = constraints_.coordinates()[k] / 2;
    add_unknown(true, vertex < n_vertices_ ? vertex : no_index);
  };
  if (is_mixed || leaves_few(n_own)) {
    for (const int vertex : factorization.order(graph_of(matrix), &positions)) {
      const auto& [u, v] = own[vertex];
      if (!is_mixed) {
        if (u != no_index) add_real(u);
        if (v != no_index) add_real(v);
      } else if (u != no_index && v != no_index) {
        unknown[u] = unknown[v] = size();
        is_imaginary[v] = 1;
        add_unknown(false, vertex);
      }
    }
    is_ordered_ = size() > 0;
  }
  for (int k = 0; k < n_coordinates; ++k) {
    if (unknown[k] == no_index) add_real(k);
  }
  terms_ = Grouped<Term>(n_vertices_, [&](const auto& visit) {
    for (int c = 0; c < 2 * n_vertices_; ++c) {
      for (Expansion::InnerIterator it(constraints_.expansion(), c); it; ++it) {
        if (is_imaginary[it.col()]) continue;  // in the same unknown as its real part
        visit(c / 2, Term{unknown[it.col()], c % 2 == 0 ? Complex(it.value()) : Complex(0, it.value())});
      }
    }
  });
  for (const int axis : {0, 1}) {
    const Eigen::VectorXd along = constraints_.translation(axis);
    if (along.size() == 0) continue;
    ComplexVector w = ComplexVector::Zero(size());
    for (Eigen::Index k = 0; k < along.size(); ++k) {
      w[unknown[k]] += is_imaginary[k] ? Complex(0, along[k]) : Complex(along[k]);
    }
    translations_.push_back(std::move(w));
  }
}

ComplexVector AffineSpace::expanded(ComplexVector w) const {
  if (is_free()) return w;
  ComplexVector x = ComplexVector::Zero(n_vertices_);
  add_expanded(w, x);
  return x;
}

void AffineSpace::add_expanded(const ComplexVector& w, ComplexVector& x) const {
  for (int k = 0; is_complex_ && k < size(); ++k) x[vertex_[k]] += w[k];
  for (int v = 0; v < terms_.n_keys(); ++v) {
    for (const auto& [unknown, factor] : terms_[v]) {
      if (is_real_[unknown]) {
        x[v] += factor * w[unknown].real();
      } else {
        x[v] += w[unknown];
      }
    }
  }
}

ComplexVector AffineSpace::gathered(const ComplexVector& z) const {
  if (is_free()) return z;
  if (is_complex_) return z(vertex_);
  ComplexVector w = ComplexVector::Zero(size());
  for (int v = 0; v < n_vertices_; ++v) {
    for (const auto& [unknown, factor] : terms_[v]) {
      if (is_real_[unknown]) {
        w[unknown] += factor.real() * z[v].real() + factor.imag() * z[v].imag();
      } else {
        w[unknown] += z[v];
      }
    }
  }
  return w;
}

HermitianMatrix AffineSpace::reduced(const HermitianMatrix& matrix) const {
  if (is_complex_) {
    return block_of(matrix, indices_in(vertex_, static_cast<std::size_t>(matrix.rows())), size());
  }
  // The lower triangle, with only the real part between real unknowns: an entry a + i b of the complex form stands for
  // the block [a, -b; b, a] of the real one.
  std::vector<Eigen::Triplet<Complex>> entries;
  entries.reserve(static_cast<std::size_t>(2 * matrix.nonZeros()));
  for (int j = 0; j < matrix.outerSize(); ++j) {
    for (HermitianMatrix::InnerIterator it(matrix, j); it; ++it) {
      const int i = static_cast<int>(it.row());
      for (const auto& [row, factor] : terms_[i]) {
        for (const auto& [column, other] : terms_[j]) {
          if (i == j && row < column) continue;
          Complex value = std::conj(factor) * it.value() * other;
          if (is_real_[row] && is_real_[column]) value.imag(0);
          // Inside the patch, u and v are not coupled; without the zeros, their factors are not, either.
          if (value == 0.0) continue;
          // An off-diagonal entry also stands for its conjugate across the diagonal.
          if (row == column && i != j) value = 2 * value.real();
          if (row >= column) {
            entries.emplace_back(row, column, value);
          } else {
            entries.emplace_back(column, row, std::conj(value));
          }
        }
      }
    }
  }
  return lower_triangle(size(), entries);
}

BoundaryForm AffineSpace::reduced(const BoundaryForm& form) const {
  if (is_free()) return form;
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(size());
  const Grouped<Term> terms = terms_of(form.vertices);
  for (int i = 0; i < terms.n_keys(); ++i) {
    for (const auto& [unknown, factor] : terms[i]) mass[unknown] += std::norm(factor) * form.mass[i];
  }
  BoundaryForm result;
  for (int k = 0; k < size(); ++k) {
    if (mass[k] > 0) result.vertices.push_back(k);
  }
  result.mass = mass(result.vertices);
  return result;
}

Grouped<AffineSpace::Term> AffineSpace::terms_of(const std::vector<int>& vertices) const {
  std::vector<int> unknown;  // of each vertex, if all are complex
  if (is_complex_) unknown = indices_in(vertex_, static_cast<std::size_t>(n_vertices_));
  return Grouped<Term>(static_cast<int>(vertices.size()), [&](const auto& visit) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const auto key = static_cast<int>(i);
      if (!is_complex_) {
        for (const Term& term : terms_[vertices[i]]) visit(key, term);
      } else if (unknown[vertices[i]] != no_index) {
        visit(key, Term{unknown[vertices[i]], 1.0});
      }
    }
  });
}

Positions AffineSpace::positions_of_unknowns(const Positions& positions) const {
  Positions result(size(), 3);
  for (int k = 0; k < size(); ++k) result.row(k) = positions.row(std::max(vertex_[k], 0));  // the origin is anywhere
  return result;
}

void AffineSpace::remove_translations(ComplexVector& w) const {
  if (is_free()) w.array() -= w.mean();
  for (const ComplexVector& along : translations_) w -= along.dot(w).real() / along.squaredNorm() * along;
}

bool AffineSpace::serves(const LinearConstraints& constraints) const {
  const Expansion& a = constraints_.expansion();
  const Expansion& b = constraints.expansion();
  return a.rows() == b.rows() && a.cols() == b.cols() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.rows() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr()) &&
         std::equal(a.valuePtr(), a.valuePtr() + a.nonZeros(), b.valuePtr());
}

AffineSpace AffineSpace::restricted(const std::vector<int>& vertices, std::vector<int>& unknowns) const {
  if (is_free()) {
    unknowns = vertices;
    return free(static_cast<int>(vertices.size()));
  }
  AffineSpace result;
  result.n_vertices_ = static_cast<int>(vertices.size());
  result.is_complex_ = is_complex_;
  unknowns.clear();
  Grouped<Term> terms = terms_of(vertices);
  std::vector<int> number(static_cast<std::size_t>(size()), no_index);
  for (int i = 0; i < terms.n_keys(); ++i) {
    for (Term& term : terms[i]) {
      int& own = number[term.unknown];
      if (own == no_index) {
        own = result.size();
        unknowns.push_back(term.unknown);
        result.add_unknown(is_real_[term.unknown] != 0, i);
      }
      term.unknown = own;
    }
  }
  if (!is_complex_) result.terms_ = std::move(terms);
  for (const ComplexVector& along : translations_) result.translations_.emplace_back(along(unknowns));
  return result;
}

}  // namespace spectral_conformal
