#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/polygon_mesh.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// The energy limit that belongs to the other limits: about the symmetric Dirichlet energy of maps whose sizes and
/// angles are as far off as these allow.
inline double energy_at(double scale_limit, double qc_limit) {
  const double octaves = std::log2(scale_limit);
  return 4 + 0.3 * octaves * octaves + 2 * (qc_limit + 1 / qc_limit - 2);
}

/// What artists call their way to cut; seam_style.h says what it means.
enum class SeamStyle { hard, organic };

struct SeamSuggestionOptions {
  SeamStyle style = SeamStyle::hard;
  double max_length = infinity;  ///< of all new seams together, in units of the positions
  double scale_limit = 1.25;     ///< above 1: stop when 95 % of the area is within this factor of the median scale
  double qc_limit = 1.1;         ///< stop when the area-weighted mean QC is at most this; at least 1
  /// Applies where only the mean QC exceeds its limit, or where no cut lowers the energy further. A cut must then lower
  /// the mean QC of the whole mesh by at least this, per length sqrt(mesh area); at least 0.
  double qc_gain = 0;
  /// Allowed symmetric Dirichlet energy of the maps (area-weighted mean, 4 for an isometry, see MapQuality); at least
  /// 4. It sets the exchange rate between distortion and seams (seam_functional.h). Like the other limits it is not a
  /// bound: exceeding it is expensive.
  double energy_limit = energy_at(1.25, 1.1);
  /// Direction from the mesh to the viewer; its length sets how strongly seams avoid being seen: an edge whose faces
  /// face the viewer costs 1 + |front| times its length. Zero: no viewer. Finite.
  std::array<double, 3> front{0, 0, 0};
  /// (n_vertices,) in [-1, 1], or null: positive attracts seams, negative repels them, 0 leaves the choice to the
  /// distortion. An edge whose ends have the mean p costs 8^-p times as much.
  const double* vertex_preference = nullptr;
  /// (n_avoided_edges,) vertex pairs in any order, or null: edges whose cost is multiplied by 1e6, so that paths avoid
  /// them by any detour; cuts to a distorted vertex inside may still take them. Pairs that are not edges are ignored.
  const std::array<int, 2>* avoided_edges = nullptr;
  int n_avoided_edges = 0;
  /// (n_preferred_edges,) vertex pairs in any order, or null: edges that the modeler has marked, as creases or borders
  /// of materials. With edge_preference (n_preferred_edges,) in [0, 1], 1 if null, the price of a seam runs from that
  /// without the mark, 0, to that along the sharpest edge, 1 (marked_price in seam_price.h). Pairs that are not edges
  /// are ignored.
  const std::array<int, 2>* preferred_edges = nullptr;
  const double* edge_preference = nullptr;
  int n_preferred_edges = 0;
  /// Whether the shortest seams that meet the limits are wanted, for maps that are measured, not looked at: an edge
  /// costs its length times the factors of the hints above, whatever its angle, turns cost nothing, and distortion
  /// within the limits is free, so seams are taken back, edge by edge, until one is reached (seam_retraction.h).
  bool shortest = false;
  /// At least 0, in units of the root of the mesh's area: what the longer side of an island's map has beyond it costs
  /// as much as a seam of that length, so that long strips are parted. At 1.75, a square sheet that has room for the
  /// island is filled to a third; the cross of a cube, 1.63, stays whole. Without effect on the shortest seams.
  double longest_side = 1.75;
  PatchOptions map;  ///< of the maps whose distortion is measured
};

struct SeamSuggestion {
  std::vector<std::array<int, 2>> edges;  ///< mesh vertices, the smaller first; distinct, and not seams before
  std::vector<int> cut_offsets{0};  ///< cut i is edges [cut_offsets[i], cut_offsets[i + 1]); mirrored cuts are one
  // For lack of memory:
  int n_given_up = 0;         ///< parts without seams
  int given_up_vertices = 0;  ///< of the largest of them
};

/// Proposes seams that lower the distortion of the spectral maps of a mesh, for each chart of build_charts. First it
/// makes the cuts that topology requires, regardless of length: it opens handles along short non-separating loops
/// (handle_cuts.h) and closed surfaces along a path between distant vertices. Then it cuts greedily from the most
/// distorted regions to the boundary: cheapest paths join the prominent extrema of the scale (field_extrema.h) and the
/// vertices of highest QC to the existing cuts (Sheffer and Hart 2002, "Seamster"). It solves each candidate, keeps it
/// only if one functional of distortion, priced length and islands falls (seam_functional.h), and prefers the one that
/// lowers it most; in the end it takes seams back and straightens them where that lowers it too. Charts with a mirror
/// plane (mirror_symmetry.h) get mirrored cuts where paths allow it. Large charts are first processed on coarse copies
/// (coarse_piece.h): the charts are cut like their copies, and further if that is not enough. Charts that still cannot
/// be solved get no seams. If the length is not limited, each chart is also split into flat parts that unfold without
/// distortion (rigid_unfolding.h), and seams not worth their length are removed; the cheaper of the two proposals wins
/// (seam_functional.h). Its seams are one cut, and need not be mirrored. The result depends neither on the numbering
/// of vertices and faces (canonical_mesh.h) nor on the scale (relative_grid.h). Throws InvalidMesh for arrays that do
/// not describe a mesh, Cancelled, and std::bad_alloc where memory is too small for the mesh or for every chart; if it
/// is too small for some charts only, those get no seams.
SeamSuggestion suggest_seams(const PolygonMesh& mesh, const SeamSuggestionOptions& options, const Progress& progress);

}  // namespace spectral_conformal
