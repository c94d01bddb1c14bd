#pragma once

#include "parameterization/patch_map.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// Held coordinates in their own unit, so that a solve does not depend on their magnitude: z = origin + unit * (what
/// `equations` hold).
struct HeldFrame {
  LinearEquations equations;
  Complex origin = 0;
  double unit = 1;
};

/// The equations, with the pins held, too. attractors: determine the origin along an axis along which nothing is held,
/// and the unit if all that is held lies at one position. Throws InvalidMesh if all attractors do, too.
HeldFrame held_frame(const LinearEquations& given, const Pins& pins, const Pins& attractors = {});

/// Stage: the LSCM map (section 2.2) of Method::lscm, which pins, held coordinates and equations hold where it is
/// (lscm.h), with extenders (held_extenders.h) and soft pins as springs; not yet placed. With fewer than two pins and
/// nothing else held, the two farthest boundary vertices are, and the map is placed like any other. `eigenvalue` is the
/// map's quotient of Eq. 5, `residual` that of solve_lscm. The problem keeps the factor for the next solve that holds
/// the same. Throws InvalidMesh if all that is held lies at one position.
PatchMap held(const SolveTask& task, PatchMap map, const Progress& progress);

/// Places z (V,) of a held map: what is held gets exactly its values.
void place_held(const SolveTask& task, ComplexVector& z);

/// Stage: moves the map onto its pins, unless they held it in the solve. One or two hard pins are met exactly; for soft
/// pins the similarity minimizes the deviation. Throws InvalidMesh if all pins have the same position.
PatchMap fitted_to_pins(const SolveTask& task, PatchMap map);

}  // namespace spectral_conformal
