#include "conformal/conformal_energy.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "concurrency/parallel_calls.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "graph/adjacency.h"
#include "linear_algebra/large_pages.h"

namespace spectral_conformal {
namespace {

/// Calls work(i) once for every i from 0 to n - 1, in several threads if n is large.
template <class Work>
void for_each_index(std::size_t n, const Work& work) {
  run_blocks_in_parallel(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}

}  // namespace

ConformalEnergy conformal_energy(const Eigen::Ref<const Positions>& positions,
                                 SharedVector<std::array<int, 3>> triangles,
                                 SharedVector<TriangleWeight> triangle_weights, Weights weights,
                                 std::size_t n_virtual) {
  ConformalEnergy result;
  result.n_virtual_ = n_virtual;
  result.n_vertices_ = static_cast<int>(positions.rows());
  std::vector<TriangleShape>& shapes = result.shapes_;
  shapes.resize(triangles.size());
  for_each_index(triangles.size(), [&](std::size_t t) {
    const auto& [a, b, c] = triangles[t];
    shapes[t] = local_isometric_frame(positions.row(a), positions.row(b), positions.row(c));
  });
  for (std::size_t t = 0; t + n_virtual < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    if (shapes[t].clamped) ++result.clamped_triangles_;
    result.area_ +=
        triangle_weights[t] *
        (shapes[t].clamped ? triangle_area(positions.row(a), positions.row(b), positions.row(c)) : shapes[t].area());
    result.weight_sum_ += triangle_weights[t];
  }
  poll(triangles.size());
  result.triangles_ = std::move(triangles);
  result.triangle_weights_ = std::move(triangle_weights);
  result.weigh(weights);
  return result;
}

ConformalEnergy ConformalEnergy::with(Weights weights) const {
  ConformalEnergy result = *this;
  result.weigh(weights);
  return result;
}

void ConformalEnergy::weigh(Weights weights) {
  weights_ = weights;
  weight_unit_ = weights == Weights::inverse_area && weight_sum_ > 0 ? area_ / weight_sum_ : 1;
}

void ConformalEnergy::stretch(const std::vector<TriangleMetric>& metric) {
  std::vector<TriangleShape> shapes = energy_shapes();
  for_each_polled(metric.size(), [&](std::size_t t) {
    if (!shapes_[t].clamped) shapes[t] = stretched(shapes[t], metric[t]);
  });
  stretched_.swap(shapes);
}

int ConformalEnergy::clamp(double min_height) {
  std::vector<TriangleShape> shapes = energy_shapes();
  int clamped = 0;
  for (TriangleShape& shape : shapes) {
    // Rounding must not make a clamped shape count again.
    if (!(shape.relative_height() < min_height * (1 - insignificant))) continue;
    shape = shape.clamped_to(min_height);
    ++clamped;
  }
  poll(shapes_.size());
  if (clamped > 0) stretched_.swap(shapes);
  return clamped;
}

double ConformalEnergy::weight(std::size_t triangle) const {
  const double in_quad = triangle_weights_[triangle];
  if (weights_ == Weights::uniform) return in_quad;
  const TriangleShape& shape = shapes_[triangle];
  // Limits the weights of tiny or thin triangles so that no entry of L exceeds those of a mean triangle by more than
  // this: a little beyond, rounding breaks the factorization.
  const double max_entry = 1 / sum_rounding;
  return in_quad / std::max(shape.area() / weight_unit_, 1 / (max_entry * shape.relative_height()));
}

/// Calls visit(i, j, w cot t / 2, w / 2) for every half-edge i -> j of every triangle with weight w and opposite angle
/// t: the half-edge's entries in E_D (Eq. 3) and in A.
template <class Visit>
void ConformalEnergy::for_each_half_edge(const Visit& visit) const {
  const std::vector<TriangleShape>& shapes = energy_shapes();
  for_each_polled(triangles_.size(), [&](std::size_t t) {
    const auto& triangle = triangles_[t];
    const TriangleShape& s = shapes[t];
    const double half_weight = 0.5 * weight(t);
    const double double_area = s.x1 * s.y2;
    // Cotangent at corner k, opposite to the half-edge from corner k+1 to corner k+2.
    const std::array<double, 3> scaled_cotangents = s.scaled_cotangents();
    for (int k = 0; k < 3; ++k) {
      const int i = triangle[(k + 1) % 3];
      const int j = triangle[(k + 2) % 3];
      if (i != j) visit(i, j, half_weight * (scaled_cotangents[k] / double_area), half_weight);
    }
  });
}

double ConformalEnergy::max_diagonal() const {
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n_vertices_);
  for_each_half_edge([&](int i, int j, double dirichlet, double) {
    diagonal[i] += dirichlet;
    diagonal[j] += dirichlet;
  });
  return std::max(0.0, diagonal.maxCoeff());
}

HermitianMatrix ConformalEnergy::matrix() const {
  // Not Complex, which would be set to 0: left unset, new memory is first touched in blocks that report their work.
  struct Entry {
    int column;
    double real;
    double imaginary;
  };
  // Of the lower triangle by rows, each edge as its two halves.
  std::vector<int> start(static_cast<std::size_t>(n_vertices_) + 1, 0);
  for (const auto& triangle : triangles_) {
    // A polygon that visits a vertex twice may yield a triangle with a side from that vertex to itself.
    for (int k = 0; k < 3; ++k) {
      if (triangle[k] != triangle[(k + 1) % 3]) ++start[std::max(triangle[k], triangle[(k + 1) % 3]) + 1];
    }
  }
  for (int v = 0; v < n_vertices_; ++v) start[v + 1] += start[v];
  poll(triangles_.size());
  LargeVector<Entry> entries(static_cast<std::size_t>(start[n_vertices_]));
  std::vector<int> fill(start.begin(), start.end() - 1);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n_vertices_);
  for_each_half_edge([&](int i, int j, double dirichlet, double half_weight) {
    diagonal[i] += dirichlet;
    diagonal[j] += dirichlet;
    // L_ij = -dirichlet + i w / 2 (minus A, Eq. 2), L_ji its conjugate.
    if (i > j) {
      entries[fill[i]++] = {j, -dirichlet, half_weight};
    } else {
      entries[fill[j]++] = {i, -dirichlet, -half_weight};
    }
  });
  // Row after row, so that every column ascends.
  const auto for_each_entry = [&](const auto& visit) {
    for_each_polled(n_vertices_, [&](int row) {
      for (int k = start[row]; k < start[row + 1]; ++k) visit(row, entries[k]);
    });
  };
  HermitianMatrix matrix;
  matrix.resize(n_vertices_, n_vertices_);
  int* const outer = matrix.outerIndexPtr();
  std::vector<int> last(static_cast<std::size_t>(n_vertices_), no_index);  // row of each column
  std::fill(outer, outer + n_vertices_ + 1, 0);
  for_each_entry([&](int row, const Entry& entry) {
    if (std::exchange(last[entry.column], row) != row) ++outer[entry.column + 1];
  });
  for (int v = 0; v < n_vertices_; ++v) outer[v + 1] += outer[v] + 1;
  matrix.resizeNonZeros(outer[n_vertices_]);
  int* const rows = matrix.innerIndexPtr();
  Complex* const values = matrix.valuePtr();
  for_each_polled(n_vertices_, [&](int v) {
    last[v] = outer[v];  // now positions
    rows[last[v]] = v;
    values[last[v]] = diagonal[v];
  });
  for_each_entry([&](int row, const Entry& entry) {
    int& position = last[entry.column];
    if (rows[position] != row) {
      rows[++position] = row;
      values[position] = 0;
    }
    values[position] += Complex(entry.real, entry.imaginary);
  });
  return matrix;
}

double ConformalEnergy::value(const ComplexVector& z) const {
  const std::vector<TriangleShape>& shapes = energy_shapes();
  double sum = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    // Eq. 2: z^H L z = 2 w E_C = 4 w |T| |f_zbar|^2 = w |4 |T| f_zbar|^2 / (4 |T|)
    const TriangleShape& s = shapes[t];
    sum += weight(t) * std::norm(s.antiholomorphic_part(z[b] - z[a], z[c] - z[a])) / (4 * s.area());
  }
  poll(triangles_.size());
  return sum;
}

double ConformalEnergy::area_form(const ComplexVector& z) const {
  double sum = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    sum += weight(t) * cross(z[b] - z[a], z[c] - z[a]);
  }
  poll(triangles_.size());
  return sum;
}

double ConformalEnergy::apply(const ComplexVector& z, ComplexVector& result) const {
  const std::vector<TriangleShape>& shapes = energy_shapes();
  result.setZero(z.size());
  double sum = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    const TriangleShape& s = shapes[t];
    const Complex part = s.antiholomorphic_part(z[b] - z[a], z[c] - z[a]);
    const double scale = weight(t) / (4 * s.area());
    sum += scale * std::norm(part);
    s.add_gradient({a, b, c}, scale * part, result.data());
  }
  poll(triangles_.size());
  return sum;
}

}  // namespace spectral_conformal
