#include "geometry/orientation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "spectral_conformal/errors.h"

namespace spectral_conformal {

int exact_orientation(Complex a, Complex b, Complex c) {
  // CGAL's exact numbers require finite values: expanding another does not terminate.
  for (const Complex p : {a, b, c}) {
    if (!is_finite(p)) throw SolveFailure(rejected(Rejection::not_finite));
  }
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
  return static_cast<int>(
      CGAL::orientation(Point(a.real(), a.imag()), Point(b.real(), b.imag()), Point(c.real(), c.imag())));
}

}  // namespace spectral_conformal
