#pragma once

#include "spectral_conformal/polygon_mesh.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// The distortion of a map per face, regardless of islands.
struct FaceDistortion {
  Eigen::VectorXd qc;          ///< (n_faces,) mean over the face's triangles, weighted by their area in 3D
  Eigen::VectorXd log2_scale;  ///< (n_faces,) log2 of sqrt(image area / area)
  Eigen::VectorXd area;        ///< (n_faces,) in 3D, units of the positions squared
  Eigen::VectorXd image_area;  ///< (n_faces,) signed, counterclockwise positive, units of the map squared
};

/// Measures a map with one point per corner, face by face, on all cores: fast enough to follow edits. Triangles are
/// those of `Distortion`: polygons are triangulated in 3D; for a quad with both splits, the split that
/// mapped_triangulation takes for an unflipped quad counts. Triangles without area in 3D do not count. A face without
/// area, or not selected, has qc 1, log2_scale 0 and zero areas. An image without area has infinite qc and log2_scale
/// minus infinity. A face with a non-finite position or UV has NaN for qc and log2_scale, and zero areas.
///
/// mesh: seams are not used. corner_uv: (n_corners, 2). Throws InvalidMesh as validate does.
FaceDistortion measure_face_distortion(const PolygonMesh& mesh, const double* corner_uv);
FaceDistortion measure_face_distortion(const PolygonMesh& mesh, const float* corner_uv);

}  // namespace spectral_conformal
