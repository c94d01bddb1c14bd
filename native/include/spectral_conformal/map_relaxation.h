#pragma once

#include <array>
#include <memory>
#include <vector>

#include "spectral_conformal/linear_constraints.h"
#include "spectral_conformal/options.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/types.h"

namespace spectral_conformal {

/// What the border of a map does.
enum class Border {
  free,
  /// Its vertices slide along it, so that the outline stays: straight parts exactly, curved ones as a smooth curve
  /// through their vertices. Corners stay.
  sliding,
  held
};

struct MapRelaxationOptions {
  /// From 0, angles alone, to 1, the symmetric Dirichlet energy.
  double sizes = 0.5;
  /// An island ends when a step with a fresh factor removes less than this fraction of its energy above the minimum.
  double tolerance = 1e-3;
  bool fold_free = false;  ///< whether to unfold flipped triangles first
  FactorizationBackend backend = FactorizationBackend::automatic;
  /// Equations for the displacements, so that a map that meets them continues to; held coordinates stay, whatever
  /// their value. Equations across islands are left out.
  LinearEquations constraints = {};
  Border border = Border::free;
};

/// Lowers the distortion of a given map, step by step. The energy is the mean, weighted by area and by the caller, of
///   (1 - sizes) (s1 / s2 + s2 / s1) + sizes (s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2)
/// over the triangles with a vertex that moves, where s1, s2 are the singular values of a triangle's Jacobian, at the
/// scale at which the island has its area in 3D (Hormann and Greiner 2000, MIPS; Smith and Schaefer, Bijective
/// Parameterization with Free Boundaries, 2015). The minimum, 2 + 2 sizes, is an isometry up to scale. Not from the
/// paper.
///
/// Triangles that share vertices form an island; each relaxes on its own, and as its mirror image if it is mirrored.
/// The number of flipped and of overlapping triangles of an island never rises: triangles with image area keep it, and
/// the border does not touch itself unless it did so at the start. An island of which nothing is fixed or constrained
/// keeps its image area. Step by step the energy falls, up to that of a barrier along the border, which is none in the
/// given map, or the number of flipped triangles does, which count with a finite substitute.
class MapRelaxation {
 public:
  /// positions: (V, 3) and z: (V,), finite at used vertices. triangles: (F, 3), wound alike; each edge should have at
  /// most two. fixed: (V,) or empty: vertices that stay exactly where they are. weights: (F,) or empty: positive
  /// factors of the areas. Throws Cancelled, and as Factorization does.
  static MapRelaxation begin(const Eigen::Ref<const Positions>& positions,
                             const std::vector<std::array<int, 3>>& triangles, ComplexVector z,
                             const std::vector<char>& fixed, const std::vector<double>& weights,
                             const MapRelaxationOptions& options, const Progress& progress = {});
  ~MapRelaxation();
  MapRelaxation(MapRelaxation&&) noexcept;

  /// Takes up to n steps on every island. Returns whether there may be more. Throws Cancelled, which leaves the map
  /// after the last whole step, and as Factorization does.
  bool advance(int n, const Progress& progress = {});

  const ComplexVector& z() const;
  /// (V,) the vertices that are fixed, by the caller or by their border.
  const std::vector<char>& fixed() const;
  /// Of the given map (unfolded, if requested). A function of the map, like `energy`: a mean over the islands with
  /// image area that can move, infinite if there are others alone, 0 if there are none.
  double energy_before() const;
  double energy() const;
  int steps() const;           ///< taken on the island with the most
  int flipped() const;         ///< triangles flipped or collapsed against their island, of those with area in 3D
  bool has_converged() const;  ///< whether every island that can move ended at its minimum, to the tolerance

 private:
  struct State;
  explicit MapRelaxation(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace spectral_conformal
