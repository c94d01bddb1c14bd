#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "seams/coarse_piece.h"
#include "seams/cutter.h"
#include "seams/edge_marks.h"
#include "seams/filled_piece.h"
#include "seams/piece_seams.h"
#include "seams/pieces.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/seam_suggestion.h"

namespace spectral_conformal {

/// The constant data shared by the searches of all pieces.
struct SearchedMesh {
  /// All must outlive this object. Of the pieces' vertices, `given_vertices` are those that options.vertex_preference
  /// is of.
  SearchedMesh(const SeamSuggestionOptions& options, const MirroredPieces& parts,
               const std::vector<int>& given_vertices);

  const SeamSuggestionOptions& options;
  const MirroredPieces& parts;
  const std::vector<int>& given_vertices;
  EdgeMarks marks;
  SeamSuggestionOptions coarse_options;  ///< of coarse copies
  double area = 0;                       ///< of the finite pieces together; 0 where options.qc_gain is and none asks
};

/// The search for the seams of one piece, independent of the others. A large piece is first searched on coarse copies,
/// each starting from the seams of the coarser one. In the end the seams of the rigid unfolding replace the result if
/// seam_functional rates them better.
class PieceSearch {
 public:
  struct Cut {
    std::vector<std::array<int, 2>> edges;  ///< the piece's vertices
    double urgency;                         ///< the length of it and what follows; infinite for what topology needs
  };

  /// `mesh` must outlive this object.
  PieceSearch(const SearchedMesh& mesh, int index);

  /// Whether no other piece is to be searched at the same time, as the maps of this one take much memory.
  bool is_large() const;
  /// Cuts what topology needs, whatever its length, and solves. Throws Cancelled.
  void begin(const Progress& progress);
  /// The next cuts, not longer than `longest` together, or the next finer copy; begin() was called, and it is not
  /// finished(). Throws Cancelled.
  void step(double longest, const Progress& progress);
  bool finished() const { return !cutter_; }

  /// The distortion that is left, of what is searched at present.
  double urgency() const;
  /// Of all new seams of the piece.
  double length() const { return cutter_ ? cutter_->seams().length(cutter_->seams().edges()) : length_; }
  /// The seams of a finished search, longest chain first, after those without which there are handles or closed charts.
  const std::vector<Cut>& cuts() const { return cuts_; }

 private:
  const Piece& piece() const;
  const PieceMirror& mirror() const;
  int n_vertices() const;
  void make_levels(const Progress& progress);
  void open(const Progress& progress);
  std::unique_ptr<Cutter> cutter(PieceSeams&& seams, bool refined) const;
  PieceSeams unseamed() const;
  PieceSeams priced(const Piece& piece, const PieceMirror& mirror) const;
  void refine(const Progress& progress);
  PieceSeams with_holes(const PieceSeams& filled) const;
  void take_unfolded(double longest, const Progress& progress);
  std::vector<double> cost_factors_of(const SeamGraph& graph, const Piece& piece) const;
  void finish();

  const SearchedMesh& mesh_;
  int index_;
  std::vector<std::unique_ptr<CoarsePiece>>
      levels_;                         ///< copies on which seams are still to be looked for, each coarser
  std::optional<FilledPiece> filled_;  ///< what the first of them is made from, where it has small holes
  std::unique_ptr<Cutter> cutter_;
  std::vector<Cut> cuts_;
  double length_ = 0;
};

}  // namespace spectral_conformal
