#include "geometry/orientation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace spectral_conformal {

int exact_orientation(Complex a, Complex b, Complex c) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
  return static_cast<int>(
      CGAL::orientation(Point(a.real(), a.imag()), Point(b.real(), b.imag()), Point(c.real(), c.imag())));
}

}  // namespace spectral_conformal
