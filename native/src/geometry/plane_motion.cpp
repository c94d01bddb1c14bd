#include "spectral_conformal/plane_motion.h"

namespace spectral_conformal {

PlaneMotion composed(const PlaneMotion& outer, const PlaneMotion& inner) {
  const Complex factor = outer.mirrors ? std::conj(inner.factor) : inner.factor;
  return {outer.factor * factor, outer.mirrors != inner.mirrors, outer(inner.offset)};
}

}  // namespace spectral_conformal
