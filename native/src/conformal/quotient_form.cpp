#include "conformal/quotient_form.h"

#include <algorithm>

#include "geometry/signed_area.h"

namespace spectral_conformal {

Complex barycenter(const std::vector<int>& indices, const ComplexVector& x) {
  Complex sum = 0;
  for (const int index : indices) sum += x[index];
  return sum / static_cast<double>(indices.size());
}

void spread_evenly(const std::vector<int>& indices, Complex force, ComplexVector& result) {
  for (const int index : indices) result[index] += force / static_cast<double>(indices.size());
}

QuotientForm::QuotientForm(const BoundaryForm& boundary) : total_(boundary.total()) { add_spread(boundary, 1); }

QuotientForm QuotientForm::area(const ConformalEnergy& energy) {
  QuotientForm result;
  // A is minus the imaginary part of L: A_ij = -i Im L_ij. Without weights it vanishes inside the patch.
  const HermitianMatrix matrix = energy.matrix();
  for (int column = 0; column < matrix.outerSize(); ++column) {
    for (HermitianMatrix::InnerIterator it(matrix, column); it; ++it) {
      if (it.value().imag() == 0 || it.row() == column) continue;
      const std::vector<int> ends = result.local({static_cast<int>(it.row()), column});
      result.couplings_.push_back({ends[0], ends[1], -it.value().imag()});
    }
  }
  return result;
}

std::vector<int> QuotientForm::local(const std::vector<int>& vertices) {
  std::vector<int> indices;
  indices.reserve(vertices.size());
  for (const int v : vertices) {
    if (v >= static_cast<int>(index_.size())) index_.resize(static_cast<std::size_t>(v) + 1, -1);
    if (index_[v] < 0) {
      index_[v] = static_cast<int>(support_.size());
      support_.push_back(v);
    }
    indices.push_back(index_[v]);
  }
  return indices;
}

void QuotientForm::add_extender(const Extender& extender) {
  differences_.push_back({local(extender.from), local(extender.to), extender.strength * total_});
}

void QuotientForm::add_spread(const BoundaryForm& loop, double beta) {
  spreads_.push_back({{local(loop.vertices), loop.mass}, beta});
}

void QuotientForm::add_attraction(const PinAttraction& attraction) {
  attractions_.push_back(attraction);
  attractions_.back().vertices = local(attraction.vertices);
}

bool QuotientForm::may_turn() const {
  return std::all_of(attractions_.begin(), attractions_.end(), [](const PinAttraction& each) { return each.may_turn; });
}

bool QuotientForm::is_definite() const {
  const auto is_positive = [](const auto& term) { return term.factor >= 0; };
  return attractions_.empty() && couplings_.empty() && std::all_of(spreads_.begin(), spreads_.end(), is_positive) &&
         std::all_of(differences_.begin(), differences_.end(), is_positive);
}

ComplexVector QuotientForm::restrict(const ComplexVector& z) const {
  ComplexVector x(static_cast<Eigen::Index>(support_.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = z[support_[static_cast<std::size_t>(i)]];
  return x;
}

Complex QuotientForm::Difference::value(const ComplexVector& x) const {
  return barycenter(from, x) - barycenter(to, x);
}

void QuotientForm::apply(const ComplexVector& x, ComplexVector& result) const {
  // B^ and beta B^_l, alpha (e_i - e_j)(e_i - e_j)^T, - weight Q (section 4.2)
  result.setZero(x.size());
  for (const Spread& spread : spreads_) spread.form.add_applied(x, spread.factor, result);
  for (const Difference& difference : differences_) {
    const Complex force = difference.factor * difference.value(x);
    spread_evenly(difference.from, force, result);
    spread_evenly(difference.to, -force, result);
  }
  for (const PinAttraction& attraction : attractions_) attraction.subtract(x, result);
  for (const auto& [row, column, factor] : couplings_) {
    // From differences, so that constants vanish exactly (A 1 = 0).
    result[row] += Complex(0, factor) * (x[column] - x[row]);
    result[column] -= Complex(0, factor) * (x[row] - x[column]);
  }
}

double QuotientForm::value(const ComplexVector& x) const {
  double sum = 0;
  for (const Spread& spread : spreads_) sum += spread.factor * spread.form.value(x);
  for (const Difference& difference : differences_) sum += difference.factor * std::norm(difference.value(x));
  for (const PinAttraction& attraction : attractions_) sum -= attraction.value(x);
  for (const auto& [row, column, factor] : couplings_) {
    sum -= 2 * factor * cross(x[row] - x[0], x[column] - x[0]);
  }
  return sum;
}

void QuotientForm::add_applied(const ComplexVector& z, double factor, ComplexVector& result) const {
  ComplexVector image;
  apply(restrict(z), image);
  for (Eigen::Index i = 0; i < image.size(); ++i) result[support_[static_cast<std::size_t>(i)]] += factor * image[i];
}

double eigen_residual(const ConformalEnergy& energy, const QuotientForm& form, const ComplexVector& z,
                      ComplexVector& r) {
  const double lambda = energy.apply(z, r) / form.value_of_map(z);
  form.add_applied(z, -lambda, r);
  return lambda;
}

}  // namespace spectral_conformal
