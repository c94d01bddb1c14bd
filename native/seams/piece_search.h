#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "seams/coarse_piece.h"
#include "seams/cutter.h"
#include "seams/filled_piece.h"
#include "seams/limit_stages.h"
#include "seams/piece_seams.h"
#include "seams/pieces.h"
#include "seams/seam_preferences.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// The constant data shared by the searches of all pieces.
struct SearchedMesh {
  /// All arguments must outlive this object. given_vertices: for each vertex of the split mesh, its index in
  /// options.vertex_preference.
  SearchedMesh(const SeamSuggestionOptions& options, const MirroredPieces& parts,
               const std::vector<int>& given_vertices);

  const SeamSuggestionOptions& options;
  const MirroredPieces& parts;
  const std::vector<int>& given_vertices;
  SeamPreferences preferences;
  double area = 0;               ///< of all finite pieces
  double sheet_side = infinity;  ///< see SeamFunctional; in units of the mesh
};

/// The search for the seams of one piece, independent of the others. A large piece is first searched on coarse copies,
/// each starting from the seams of the coarser one. The search only sees positions rounded to a grid relative to the
/// piece: a shape gets the same seams at any scale. In the end the seams of the rigid unfolding, of a grid of edge
/// loops, or of a search that cuts along whole edge loops too, replace the result if SeamFunctional rates them better.
/// If that was for looser limits than those asked for (limit_stages.h), more cuts follow.
class PieceSearch {
 public:
  struct Cut {
    std::vector<std::array<int, 2>> edges;  ///< pairs of the piece's vertices
    double urgency;                         ///< length of this and all later cuts; infinite if topology needs it
  };

  /// `mesh` must outlive this object.
  PieceSearch(const SearchedMesh& mesh, int index);

  /// Whether to search no other piece at the same time: the maps of this one need much memory.
  bool is_large() const;
  /// LimitStages::begins_looser.
  bool begins_looser() const { return stages_.begins_looser(); }
  /// Makes the cuts that topology needs, of any length, and solves. Throws Cancelled.
  void begin(const Progress& progress);
  /// Makes the next cuts, of total length `longest` at most, or moves on to the next finer copy. Precondition: begin()
  /// was called, the search is not finished(), and `longest` is finite if, and only if,
  /// SeamSuggestionOptions::max_length is. Throws Cancelled.
  void step(double longest, const Progress& progress);
  bool finished() const { return !cutter_; }

  /// The distortion left in the copy being searched, times its area, in single precision, so that rounding errors do
  /// not decide; infinite without a map.
  double urgency() const;
  /// The length of all new seams of the piece.
  double length() const { return cutter_ ? cutter_->seams().length(cutter_->seams().edges()) : length_; }
  /// The seams of a finished search: first the chains that open handles and closed charts, then the others, longest
  /// first.
  const std::vector<Cut>& cuts() const { return cuts_; }

 private:
  const Piece& given() const { return mesh_.parts.pieces[index_]; }
  const PieceMirror& mirror() const;
  int n_vertices() const;
  void make_levels(const Progress& progress);
  void open(const Progress& progress);
  std::unique_ptr<Cutter> cutter(PieceSeams&& seams, bool refined, bool whole_loops = false) const;
  double least_turn() const;
  PieceSeams unseamed() const;
  PieceSeams unseamed_filled() const;
  PieceSeams priced(const Piece& piece, const PieceMirror& mirror) const;
  void refine(const Progress& progress);
  PieceSeams with_holes(const PieceSeams& filled) const;
  std::unique_ptr<Cutter> without_fill(std::unique_ptr<Cutter> found, const Progress& progress) const;
  void drop_fill();
  void unfold();
  bool is_beaten(const Cutter& search, double rival) const;
  bool is_unfolded(const Progress& progress);
  void take_unfolded(const Progress& progress);
  double unfolding_bonus() const;
  void take_loops(double longest, const Progress& progress);
  void take_grid(const PieceSeams& uncut, const Progress& progress);
  void take_if_better(std::unique_ptr<Cutter> other, double bonus = 1);
  void extend(const Progress& progress);
  bool enters_stage();
  void finish();

  const SearchedMesh& mesh_;
  int index_;
  Piece piece_;      ///< the given one, its positions rounded (relative_grid.h), while it is searched
  double unit_ = 1;  ///< of its lengths
  std::vector<std::unique_ptr<CoarsePiece>> levels_;  ///< copies still to be searched, each coarser than the one before
  std::optional<FilledPiece> filled_;                 ///< the piece if it has small holes and copies, without those
  std::unique_ptr<Cutter> cutter_;
  std::unique_ptr<Cutter> unfolded_;      ///< with the seams of a rigid unfolding, until they are rated
  double least_of_unfolding_ = infinity;  ///< the cost of those seams, over the root of the area
  double bonus_ = 1;                      ///< of its seams, by which they are rated better
  std::vector<Cut> cuts_;
  double length_ = 0;
  LimitStages stages_;
  SeamSuggestionOptions first_options_;   ///< of the first stage
  SeamSuggestionOptions coarse_options_;  ///< the same for coarse copies
  SeamSuggestionOptions stage_options_;   ///< of the present stage, if it is a later one
  bool extends_ = false;                  ///< whether a later stage has begun
};

}  // namespace spectral_conformal
