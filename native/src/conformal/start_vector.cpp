#include "conformal/start_vector.h"

#include <cmath>
#include <cstdint>

#include "graph/mixed_bits.h"

namespace spectral_conformal {

ComplexVector start_vector(const BoundaryForm& form, unsigned start) {
  std::uint64_t drawn = 0;
  const auto random = [&] { return pseudo_random(++drawn, start + 1); };
  ComplexVector z(form.mass.size());
  // Enough for a component along every eigenvector, too little to lose the circle.
  const double noise = start == 0 ? 0.05 : 1.0;
  const double total = form.total();
  double passed = 0;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double angle = 2 * pi * passed / total;
    const double real = random();
    const double imaginary = random();
    z[i] = (start == 0 ? std::polar(1.0, angle) : Complex(0)) + noise * Complex(real, imaginary);
    passed += form.mass[i];
  }
  return z;
}

}  // namespace spectral_conformal
