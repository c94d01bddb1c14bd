#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/polygon_mesh.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

struct SeamSuggestionOptions {
  double max_length =
      std::numeric_limits<double>::infinity();  ///< of all new seams together, in units of the positions
  double scale_limit = 2;  ///< a factor above 1: enough when 95 % of the area has a scale within it of the median
  double qc_limit = 1.1;   ///< enough when the mean QC, weighted by area, is not above it; at least 1
  /// Where nothing but the mean QC is beyond its limit, or no cut lowers the energy any more: what a cut has to lower
  /// the mean QC of the whole mesh by for each length of the root of the mesh's area, or it is not made; at least 0.
  double qc_gain = 0;
  /// Enough when the symmetric Dirichlet energy of the maps (mean weighted by area, 4 for an isometry, see MapQuality)
  /// is not above it; at least 4.
  double energy_limit = 4.3;
  /// Where the viewer stands, as a direction from the mesh; its length says how much seams keep out of sight: an edge
  /// whose faces look at the viewer costs 1 + |front| times its length. Zero: seen from nowhere. Finite.
  std::array<double, 3> front{0, 0, 0};
  /// (n_vertices,) from -1 to 1, or null: above 0 prefers seams there, below 0 avoids them; 0 leaves the choice to the
  /// distortion. An edge with the mean p of its ends costs 8^-p times as much.
  const double* vertex_preference = nullptr;
  PatchOptions map;  ///< of the maps whose distortion counts
};

struct SeamSuggestion {
  std::vector<std::array<int, 2>> edges;  ///< vertices of the mesh, the smaller first; none twice, none a seam before
  std::vector<int> cut_offsets{0};  ///< cut i is edges [cut_offsets[i], cut_offsets[i + 1]); mirrored cuts are one
  std::string message;  ///< parts that there is too little memory for, which got no seams; empty where there are none
};

/// Proposes seams that lower the distortion of the spectral maps of a mesh, chart by chart as build_charts cuts it.
/// First what topology needs, whatever its length: handles are cut open along short loops that do not separate the
/// surface (see handle_cuts.h), closed surfaces along a path between vertices far apart. Then, greedily, from the most
/// distorted regions to the boundary: the prominent extrema of the scale (see field_extrema.h), and the vertices with
/// the highest QC, are joined to the cuts by cheapest paths (Sheffer and Hart 2002, "Seamster"). Each cut is solved and
/// kept only if the distortion falls; of several the one is taken that lowers it most for its length. Charts whose
/// faces a mirror plane (see mirror_symmetry.h) maps onto each other get mirrored cuts, where paths allow that. Of
/// large charts all this is done on copies with few vertices first (see coarse_piece.h), and the charts themselves are
/// cut where their copies are, and further where that is not enough. Charts that cannot be solved even so get no seams.
/// Where the length is not limited, a chart is also taken apart into flat parts that unfold without distortion (see
/// rigid_unfolding.h), seams that are not worth it are taken back, and of the two the seams are proposed that cost less
/// (see seam_functional.h); such seams are one cut, and need not be mirrored.
/// The numbering of vertices and faces makes no difference (see canonical_mesh.h). Throws InvalidMesh for arrays that
/// do not describe a mesh, Cancelled, and std::bad_alloc where there is too little memory for the mesh, or for any of
/// its charts; those that are too large while others are not get no seams.
SeamSuggestion suggest_seams(const PolygonMesh& mesh, const SeamSuggestionOptions& options, const Progress& progress);

}  // namespace spectral_conformal
