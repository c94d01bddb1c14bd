#include "conformal/start_vector.h"

#include <cmath>
#include <cstdint>

namespace spectral_conformal {
namespace {

/// Deterministic numbers in (-1, 1) (SplitMix64, Steele et al. 2014): the same on every platform.
class PseudoRandom {
 public:
  explicit PseudoRandom(std::uint64_t seed) : state_(seed) {}
  double next() {
    std::uint64_t x = (state_ += 0x9e3779b97f4a7c15ULL);
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    x ^= x >> 31;
    return static_cast<double>(x >> 11) * 0x1.0p-52 - 1.0;
  }

 private:
  std::uint64_t state_;
};

}  // namespace

ComplexVector start_vector(const BoundaryForm& form, unsigned start) {
  PseudoRandom random(start + 1);
  ComplexVector y(form.mass.size());
  // Enough for a component along every eigenvector, too little to lose the circle.
  const double noise = start == 0 ? 0.05 : 1.0;
  const double total = form.total();
  double passed = 0;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double angle = 2 * pi * passed / total;
    const double real = random.next();
    const double imaginary = random.next();
    y[i] = (start == 0 ? std::polar(1.0, angle) : Complex(0)) + noise * Complex(real, imaginary);
    y[i] *= std::sqrt(form.mass[i]);
    passed += form.mass[i];
  }
  return y;
}

}  // namespace spectral_conformal
