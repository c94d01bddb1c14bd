#pragma once

#include "spectral_conformal/polygon_mesh.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// What a map does to every face of a mesh by itself, whatever its islands are.
struct FaceDistortion {
  Eigen::VectorXd qc;          ///< (n_faces,) mean over the face's triangles, weighted by their area in 3D
  Eigen::VectorXd log2_scale;  ///< (n_faces,) log2 of the root of (image area / area)
  Eigen::VectorXd area;        ///< (n_faces,) in 3D, units of the positions squared
  Eigen::VectorXd image_area;  ///< (n_faces,) signed, counter-clockwise positive, units of the map squared
};

/// Measures a map with one point per corner, face by face, in as many threads as there are cores: fast enough to follow
/// edits. Triangles as in `Distortion`; polygons are triangulated in 3D, and of a quad with both splits the one counts
/// that mapped_triangulation takes where the quad is not flipped. A triangle without area in 3D does not count, a face
/// without any, or one that is not selected, has qc 1, log2_scale 0 and no areas. An image without area has an infinite
/// qc, and a log2_scale of minus infinity; a face with a position or a UV that is not finite has a qc and a log2_scale
/// that are not numbers, and no areas.
///
/// mesh: seams are not used. corner_uv (n_corners, 2). Throws InvalidMesh as validate does.
FaceDistortion measure_face_distortion(const PolygonMesh& mesh, const double* corner_uv);
FaceDistortion measure_face_distortion(const PolygonMesh& mesh, const float* corner_uv);

}  // namespace spectral_conformal
