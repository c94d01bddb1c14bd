#pragma once

#include <functional>
#include <vector>

#include "spectral_conformal/options.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// x = R b, both (V,): R is the inverse of L on the maps that a solve leaves free; x is 0 where everything is held.
using HeldInverse = std::function<ComplexVector(const ComplexVector& b)>;

/// Moves z, (V,), a map that minimizes E_C with some of it held (lscm.h), by extenders (section
/// 4.2). There is no form B to which a push could be added. Let d z be the difference of a pair's barycenters and g = d
/// R d^T its compliance, and s its strength in units of Extender::half. Pulls, s < 0, add |s| / g |d z|^2 to z^H L z,
/// all at once. A push, s > 0, then adds the constant force s / g d^T (d z) to L z = 0, with d z under the pulls. A
/// single push thus multiplies the distance of its pair by 1 + s, a single pull divides it by 1 + |s|, at any
/// resolution and scale, and no strengths make the problem indefinite. Without constraints, the map of a single push is
/// also the stationary one of
///   z^H (L - t / g d^T d) z,   t = s / (1 + s) < 1,
/// which becomes singular at t = 1.
///
/// may_turn: whether R commutes with turns of the map, as it does without linear constraints; otherwise g is the larger
/// of two compliances. max_diagonal: largest diagonal entry of L where R is not 0; pairs that cannot move are left out.
void push_and_pull(const std::vector<Extender>& given, const HeldInverse& inverse, bool may_turn, double max_diagonal,
                   ComplexVector& z);

}  // namespace spectral_conformal
