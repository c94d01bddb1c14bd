#pragma once

#include "conformal/conformal_energy.h"
#include "layout/island_outline.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The unit complex number that turns a map z upright by multiplication. It depends on the surface and the shape of its
/// map, not on the rotation, position or scale of z, nor on the numbering of the vertices.
///
/// Up is the direction in which the third coordinate of the positions grows: the gradient of its best linear fit on the
/// map, with vertices weighted by their area in the map. If that is weak compared with the other coordinates, as on a
/// floor or a dome, the second coordinate points up, as seen from above. If that is weak too, the first one points to
/// the right.
///
/// The map is not turned by an arbitrary angle, which would tilt straight borders, but by the nearest quarter turn of
///  - its mirror axis, if it is oblong and has one, unless that is a diagonal, as of a square; a single axis is
///    vertical if the third coordinate is weak;
///  - otherwise an edge of the outer loop along which the loop is about shortest in the Manhattan metric, if most of
///    the loop runs along and across one direction, as for a letter L or a cross;
///  - otherwise an edge of its convex hull on which its bounding box has about the smallest perimeter.
/// A round outline stands upright to about a degree. Among about equally near quarter turns the other coordinates
/// decide; if no coordinate does, the shape: higher than wide, the broader end down.
///
/// Precondition: z finite, with positive area.
Complex upright_turn(const ComplexVector& z, const ConformalEnergy& energy, const BoundaryLoop& outer_loop,
                     const Eigen::Ref<const Positions>& positions);

/// The turn by at most an eighth that straightens an outline: the nearest of those that `upright_turn` chooses among by
/// the shape alone. 1 if the outline is straight up to rounding, or has no extent.
Complex straight_turn(const IslandOutline& outline);

/// Whether most of an outline runs along and across one direction, as of a letter L or a cross.
bool is_rectilinear(const IslandOutline& outline);

}  // namespace spectral_conformal
