#include "conformal/correction.h"

#include <cmath>

namespace spectral_conformal {

QuotientForm quotient_form(const BoundaryForm& form) {
  return {
      [&form](const ComplexVector& z) { return form.value(z); },
      [&form](const ComplexVector& z, double factor, ComplexVector& result) { form.add_applied(z, factor, result); }};
}

double eigen_residual(const ConformalEnergy& energy, const QuotientForm& form, const ComplexVector& z,
                      ComplexVector& r) {
  const double lambda = energy.apply(z, r) / form.value(z);
  form.add_applied(z, -lambda, r);
  return lambda;
}

Correction correct(ReducedFactor& factor, const ConformalEnergy& energy, const QuotientForm& form,
                   const CorrectionOptions& options, ComplexVector& z) {
  Correction result;
  result.change = infinity;
  ComplexVector r;
  for (int k = 0; k < options.max_corrections; ++k) {
    const double lambda = eigen_residual(energy, form, z, r);
    const ComplexVector d = factor.inverse(r);
    ++result.solves;
    double step = 1;
    if (options.exact_step) {
      // The quotient along z - t d is stationary where t = d^H r / (d^H L d - lambda d^H B d), to first order.
      const double slope = d.dot(r).real();
      if (slope == 0) {
        result.change = 0;
        break;
      }
      step = slope / (energy.value(d) - lambda * form.value(d));
      if (!(step > 0) || !std::isfinite(step)) {
        result.change = unmeasured;
        break;
      }
    }
    const double change = step * d.norm() / z.norm();
    if (options.only_falling && !(change < result.change)) break;
    result.change = change;
    z -= step * d;
    if (!(change > options.negligible)) break;
  }
  return result;
}

}  // namespace spectral_conformal
