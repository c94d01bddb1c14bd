#include "conformal/boundary_form.h"

#include <numeric>

namespace spectral_conformal {

Complex BoundaryForm::barycenter(const ComplexVector& z) const {
  Complex sum = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) sum += mass[i] * z[vertices[i]];
  return sum / total();
}

void BoundaryForm::add_applied(const ComplexVector& z, double factor, ComplexVector& result) const {
  // B^ z = M z - M 1 (1^T M z) / (1^T M 1) (Eq. 7)
  const Complex mean = barycenter(z);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    result[vertices[i]] += factor * mass[static_cast<Eigen::Index>(i)] * (z[vertices[i]] - mean);
  }
}

double BoundaryForm::value(const ComplexVector& z) const {
  // z^H B^ z: u^T B u of Eq. 6, z taken about its barycenter
  const Complex center = barycenter(z);
  double result = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) result += mass[i] * std::norm(z[vertices[i]] - center);
  return result;
}

BoundaryForm boundary_form(const BoundaryLoop& loop, const Eigen::Ref<const Positions>& positions,
                           BoundaryMeasure measure) {
  BoundaryForm form;
  std::vector<double> mass;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    double m = 1;
    if (measure == BoundaryMeasure::length) {
      const auto previous = positions.row(loop[(i + loop.size() - 1) % loop.size()]);
      const auto here = positions.row(loop[i]);
      const auto next = positions.row(loop[(i + 1) % loop.size()]);
      m = 0.5 * ((here - previous).norm() + (next - here).norm());
    }
    if (m > 0) {
      form.vertices.push_back(loop[i]);
      mass.push_back(m);
    }
  }
  form.mass = Eigen::Map<const Eigen::VectorXd>(mass.data(), static_cast<Eigen::Index>(mass.size()));
  return form;
}

BoundaryForm identity_form(int n_vertices) {
  BoundaryForm form;
  form.vertices.resize(static_cast<std::size_t>(n_vertices));
  std::iota(form.vertices.begin(), form.vertices.end(), 0);
  form.mass = Eigen::VectorXd::Ones(n_vertices);
  return form;
}

}  // namespace spectral_conformal
