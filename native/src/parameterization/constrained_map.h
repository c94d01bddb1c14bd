#pragma once

#include <vector>

#include "parameterization/map_check.h"
#include "parameterization/normalized_patch.h"
#include "parameterization/patch_map.h"
#include "parameterization/spectral_map.h"
#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/step.h"

namespace spectral_conformal {

/// Adds the folds of z (V,) to its check. Where a free map would wind around several times, straight sides turn back on
/// themselves and fold the map over: flipped triangles then cover 20 to 50 % of its area, under the strongest pulls
/// that leave its shape 3 %.
MapCheck with_folds(const NormalizedPatch& patch, const ComplexVector& z, MapCheck check);

/// Places z (V,) of a spectral map under linear constraints. It is not turned, which the constraints exclude; its mean
/// moves to the origin along each axis that they leave free, and it gets the area in 3D.
void place_constrained(const SolveTask& task, ComplexVector& z);

/// The contradiction in equations: an edge or triangle without extent in every map that meets them and the `held` pins.
/// A step with Rejection::none if there is none. Throws InvalidMesh if all that is held lies at one position, and
/// all attractors do.
Step contradiction(const NormalizedPatch& patch, const LinearEquations& equations, const Pins& held = {},
                   const Pins& attractors = {});

/// Renumbers the vertices of a contradiction by `vertices`, unless these are empty.
Step with_vertices(Step contradiction, const std::vector<int>& vertices);

/// Stage: if the map of Eq. 5 under constraints winds around several times, folds over or has flipped triangles, takes
/// the map nearest to the free one (nearest_map.h), if that is better.
PatchMap nearest_to_free(const SolveTask& task, PatchMap map, const Progress& progress);

}  // namespace spectral_conformal
