#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "linear_algebra/factorization.h"
#include "relaxation/boundary_barrier.h"
#include "relaxation/distortion_energy.h"
#include "relaxation/equation_projection.h"
#include "relaxation/sliding_border.h"
#include "spectral_conformal/progress.h"
#include "spectral_conformal/relaxation_status.h"

namespace spectral_conformal {

struct DescentOptions {
  DistortionMeasure measure = DistortionMeasure::symmetric_dirichlet;
  /// Stop when a step with a fresh factor removes less than this fraction of the energy above its infimum.
  double tolerance = 1e-2;
  /// Bounds the time: each factorization, with its steps, takes a few times as long as one of the conformal energy.
  int max_factorizations = 20;
  /// Whether triangles with next to no image area keep their barrier too, which takes longer but leaves none behind.
  bool keep_all_barriers = false;
  /// Whether triangles with image area may lose it on the way: all are regularized until all have area. Where many are
  /// flipped, those that are not bar the way of those that are.
  bool may_flip = false;
  /// Called after every step; true stops the descent. Empty: never.
  std::function<bool(const ComplexVector&)> is_enough = {};
  /// Added to the energy: a boundary that does not touch itself at the start never will. May be null.
  const BoundaryBarrier* boundary = nullptr;
  /// If positive, the energy is that of the map scaled to this image area, whatever its own scale: that of the elements
  /// and of `area_elsewhere`, which does not move. While triangles are without image area, the map is not scaled.
  double area = 0;
  double area_elsewhere = 0;
  /// Linear equations that a map keeps meeting; they hold the `fixed` vertices, too. May be null.
  const EquationProjection* equations = nullptr;
  /// Vertices that slide along their border, from where its curves were laid; in no equation. May be null.
  const SlidingBorder* sliding = nullptr;
};

struct Descent {
  RelaxationStatus status = RelaxationStatus::factorization_limit;  ///< of the round of the returned map
  /// Of the given and of the returned map, each with its elements' determinant regularization at that time, and with
  /// the boundary's energy.
  double energy_before = 0;
  double energy = 0;
  int iterations = 0;      ///< steps taken, including rejected rounds
  int factorizations = 0;  ///< including rejected rounds and repetitions because of rounding
};

/// Minimizes a distortion energy. The direction comes from a quadratic form that approximates the Hessian, reweighted
/// as by Rabinovich, Poranne, Panozzo and Sorkine-Hornung (Scalable Locally Injective Mappings, 2017), but Hermitian in
/// one complex unknown per vertex; L-BFGS steps (Liu and Nocedal 1989) reuse its factor. No step removes the image area
/// of a triangle: the map moves continuously without new flips, so its turning number is preserved. The determinants of
/// elements without image area, or of all (DescentOptions::may_flip), are regularized, in up to three rounds of
/// decreasing regularization; an element that gains area gets its barrier. A round that leaves no fewer flipped
/// triangles than the previous one is rejected: map and regularization are restored.
///
/// elements: weights with a sum of about 1, regularization 0 or infinite, triangles connected; returned with the
/// regularization of the returned map, whose energy is finite. z: (V,), finite. fixed: (V,) or empty, vertices that
/// must not move. Throws Cancelled, and as Factorization does.
Descent descend(std::vector<DistortionElement>& elements, const std::vector<char>& fixed, ComplexVector& z,
                FactorizationBackend backend, const DescentOptions& options, const Progress& progress = {});

/// The first round of the same descent, step by step, so that a caller can show the map on its way. The form is
/// analyzed once; the factor and the steps that it serves are kept from one call to the next.
class StepwiseDescent {
 public:
  static StepwiseDescent begin(std::vector<DistortionElement> elements, std::vector<char> fixed, ComplexVector z,
                               FactorizationBackend backend, const DescentOptions& options);
  ~StepwiseDescent();
  StepwiseDescent(StepwiseDescent&&) noexcept;

  /// Takes a step. Returns whether there may be more.
  bool advance(const Progress& progress = {});
  const ComplexVector& z() const;
  const std::vector<DistortionElement>& elements() const;
  const Descent& result() const;

 private:
  struct State;
  explicit StepwiseDescent(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace spectral_conformal
