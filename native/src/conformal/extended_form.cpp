#include "conformal/extended_form.h"

#include <algorithm>

namespace spectral_conformal {

Complex barycenter(const std::vector<int>& indices, const ComplexVector& x) {
  Complex sum = 0;
  for (const int index : indices) sum += x[index];
  return sum / static_cast<double>(indices.size());
}

void spread_evenly(const std::vector<int>& indices, Complex force, ComplexVector& result) {
  for (const int index : indices) result[index] += force / static_cast<double>(indices.size());
}

ExtendedForm::ExtendedForm(const BoundaryForm& boundary) : total_(boundary.total()) { add_spread(boundary, 1); }

std::vector<int> ExtendedForm::local(const std::vector<int>& vertices) {
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

void ExtendedForm::add_extender(const Extender& extender) {
  differences_.push_back({local(extender.from), local(extender.to), extender.strength * total_});
}

void ExtendedForm::add_spread(const BoundaryForm& loop, double beta) {
  spreads_.push_back({{local(loop.vertices), loop.mass}, beta});
}

void ExtendedForm::add_attraction(const PinAttraction& attraction) {
  attractions_.push_back(attraction);
  attractions_.back().vertices = local(attraction.vertices);
}

bool ExtendedForm::may_turn() const {
  return std::all_of(attractions_.begin(), attractions_.end(), [](const PinAttraction& each) { return each.may_turn; });
}

ComplexVector ExtendedForm::restrict(const ComplexVector& z) const {
  ComplexVector x(static_cast<Eigen::Index>(support_.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = z[support_[static_cast<std::size_t>(i)]];
  return x;
}

Complex ExtendedForm::Difference::value(const ComplexVector& x) const {
  return barycenter(from, x) - barycenter(to, x);
}

void ExtendedForm::apply(const ComplexVector& x, ComplexVector& result) const {
  // B^ and beta B^_l, alpha (e_i - e_j)(e_i - e_j)^T, - weight Q (section 4.2)
  result.setZero(x.size());
  for (const Spread& spread : spreads_) spread.form.add_applied(x, spread.factor, result);
  for (const Difference& difference : differences_) {
    const Complex force = difference.factor * difference.value(x);
    spread_evenly(difference.from, force, result);
    spread_evenly(difference.to, -force, result);
  }
  for (const PinAttraction& attraction : attractions_) attraction.subtract(x, result);
}

double ExtendedForm::value(const ComplexVector& x) const {
  double sum = 0;
  for (const Spread& spread : spreads_) sum += spread.factor * spread.form.value(x);
  for (const Difference& difference : differences_) sum += difference.factor * std::norm(difference.value(x));
  for (const PinAttraction& attraction : attractions_) sum -= attraction.value(x);
  return sum;
}

void ExtendedForm::add_applied(const ComplexVector& z, double factor, ComplexVector& result) const {
  ComplexVector image;
  apply(restrict(z), image);
  for (Eigen::Index i = 0; i < image.size(); ++i) result[support_[static_cast<std::size_t>(i)]] += factor * image[i];
}

}  // namespace spectral_conformal
