#include "injective/fold_free_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/quad_splits.h"
#include "geometry/tolerances.h"
#include "injective/grid_embedding.h"
#include "injective/local_unfolding.h"
#include "injective/tutte_embedding.h"
#include "quality/map_degree.h"
#include "quality/overlap.h"
#include "quality/turning_number.h"
#include "relaxation/descent.h"
#include "spectral_conformal/errors.h"

namespace spectral_conformal {
namespace {

class FoldFree {
 public:
  FoldFree(const FoldFreePatch& patch, const Progress& progress) : patch_(patch), progress_(progress) {}

  FoldFreeMap run(ComplexVector given) {
    list_elements();
    FoldFreeMap result = without_folds(std::move(given));
    if (patch_.moves_apart && result.is_locally_injective) {
      if (patch_.held.empty()) {
        move_apart(result);
      } else {
        result.covers_itself = result.covered_itself = covers_itself(result.z);
      }
    }
    result.turning_number = turning_number_of(result.z);
    return result;
  }

 private:
  enum class Boundary { free, apart };

  void list_elements() {
    const ConformalEnergy& energy = patch_.energy;
    const std::size_t n = energy.triangles().size() - energy.n_virtual();
    const auto end = static_cast<std::ptrdiff_t>(n);
    triangles_.assign(energy.triangles().begin(), energy.triangles().begin() + end);
    const std::vector<TriangleShape>& all_shapes = patch_.sizes > 0 ? energy.shapes() : energy.energy_shapes();
    const std::vector<TriangleShape> shapes(all_shapes.begin(), all_shapes.begin() + end);
    const std::vector<TriangleWeight> triangle_weights(energy.triangle_weights().begin(),
                                                       energy.triangle_weights().begin() + end);
    poll(n);
    elements_ = distortion_elements(triangles_, shapes, triangle_weights, 0);
    std::size_t next = 0;
    const std::vector<int> drawable = drawable_triangulation(triangles_, triangle_weights);
    for_each_polled(drawable.size(), [&](std::size_t i) {
      const auto chosen = static_cast<std::size_t>(drawable[i]);
      for (; next < chosen; ++next) elements_[next].measured = false;
      single_.push_back(triangles_[chosen]);
      ++next;
    });
    for (; next < elements_.size(); ++next) elements_[next].measured = false;
  }

  FoldFreeMap without_folds(ComplexVector given) {
    FoldFreeMap result;
    result.z = std::move(given);
    if (result.z.size() > 0) {
      result.flipped_before = result.flipped = count_flipped(elements_, result.z, unplaced);
      if (result.flipped > 0) {
        const Progress first = part(progress_, 0, 0.3);
        result.flipped = unfold_locally(elements_, patch_.held, patch_.backend, result.z, first);
      }
      result.is_locally_injective = result.flipped == 0 && goes_round_once(result.z);
      if (patch_.relaxes && result.is_locally_injective && patch_.held.empty()) {
        ComplexVector z = result.z;
        result.relaxation = settle(clamped_elements(), part(progress_, 0.3, 0.9), z);
        if (count_flipped(elements_, z, unplaced) == 0 && goes_round_once(z)) result.z = std::move(z);
      }
      if (result.is_locally_injective || !patch_.held.empty()) return result;
    }
    FoldFreeMap embedded = embed(part(progress_, 0.3, 1));
    embedded.flipped_before = result.flipped_before;
    if (result.z.size() > 0 && !embedded.is_locally_injective) return result;
    if (embedded.z.size() == 0) {
      throw SolveFailure(rejected(Rejection::no_embedding));
    }
    return embedded;
  }

  void move_apart(FoldFreeMap& map) {
    const auto is_apart = [this](const ComplexVector& z) { return has_degree_at_most_one(patch_.loops, z); };
    map.covers_itself = map.covered_itself = covers_itself(map.z);
    if (!map.covers_itself) return;
    ComplexVector z = map.z;
    DescentOptions options;
    options.keep_all_barriers = true;
    options.is_enough = is_apart;
    relax(clamped_elements(), options, part(progress_, 0.9, 0.92), z);
    if (is_apart_in_shape(z)) {
      map.z = z;
      map.covers_itself = false;
      // The relaxation toward an isometry moved them farther than necessary.
      settle_apart(part(progress_, 0.92, 1), z);
      if (is_apart_in_shape(z)) map.z = std::move(z);
      return;
    }
    FoldFreeMap embedded = embed_apart(part(progress_, 0.92, 1));
    if (!embedded.is_locally_injective || !is_apart_in_shape(embedded.z)) return;
    embedded.flipped_before = map.flipped_before;
    embedded.covered_itself = embedded.came_apart_embedded = true;
    map = std::move(embedded);
  }

  /// Whether a map is one-to-one and most of it is no slivers: more use than one that overlaps itself.
  bool is_apart_in_shape(const ComplexVector& z) const {
    if (count_flipped(elements_, z, unplaced) > 0 || !goes_round_once(z) || covers_itself(z)) return false;
    double slivers = 0;
    double others = 0;
    for (const DistortionElement& element : elements_) {
      if (!element.measured) continue;
      (jacobian(element, z).is_sliver() ? slivers : others) += element.weight;
    }
    poll(elements_.size());
    return slivers < others;
  }

  /// Precondition: no triangle is flipped.
  bool covers_itself(const ComplexVector& z) const {
    if (has_degree_at_most_one(patch_.loops, z)) return false;
    const std::vector<bool> overlapping = overlapping_triangles(single_, z);
    return std::find(overlapping.begin(), overlapping.end(), true) != overlapping.end();
  }

  int turning_number_of(const ComplexVector& z) const {
    const std::vector<TriangleWeight> whole(single_.size());
    return turning_number(patch_.loops.front(), single_, whole, z);
  }

  /// Whether the triangles wind once around every inner vertex, and the outer loop once around the map.
  bool goes_round_once(const ComplexVector& z) const {
    if (std::abs(turning_number_of(z)) != 1) return false;
    std::vector<double> angle(static_cast<std::size_t>(z.size()), 0);
    for (const auto& triangle : single_) {
      for (int k = 0; k < 3; ++k) {
        const Complex next = z[triangle[(k + 1) % 3]] - z[triangle[k]];
        const Complex previous = z[triangle[(k + 2) % 3]] - z[triangle[k]];
        angle[triangle[k]] += std::arg(std::conj(next) * previous);
      }
      poll();
    }
    for (const BoundaryLoop& loop : patch_.loops) {
      for (const int v : loop) angle[v] = 0;
    }
    // Angle sums are multiples of 2 pi up to rounding: test halfway between once and twice.
    return std::none_of(angle.begin(), angle.end(), [](double sum) { return sum > 3 * pi; });
  }

  FoldFreeMap embed(const Progress& progress) {
    FoldFreeMap result;
    result.z = embedding(part(progress, 0, 0.4));
    if (result.z.size() == 0) return result;
    const std::vector<DistortionElement> clamped = clamped_elements();
    // The first descent need not converge as far as the second, whose result is visible.
    relax(clamped, from_afar(DistortionMeasure::symmetric_dirichlet, 1e-2), part(progress, 0.4, 0.7), result.z);
    result.relaxation = settle(clamped, part(progress, 0.7, 1), result.z);
    finish(result);
    return result;
  }

  /// An embedding relaxed without letting its boundary touch itself. Contacts slow it down, so it takes more steps,
  /// each with little gain.
  FoldFreeMap embed_apart(const Progress& progress) {
    FoldFreeMap result;
    result.z = embedding(part(progress, 0, 0.2));
    if (result.z.size() == 0) return result;
    relax(clamped_elements(), from_afar(DistortionMeasure::symmetric_dirichlet, 1e-4), part(progress, 0.2, 0.6),
          result.z, Boundary::apart);
    result.relaxation = settle_apart(part(progress, 0.6, 1), result.z);
    finish(result);
    return result;
  }

  /// An embedding, or an empty vector.
  ComplexVector embedding(const Progress& progress) const {
    ComplexVector z =
        tutte_embedding(single_, patch_.loops, 0, patch_.positions, patch_.backend, part(progress, 0, 0.7));
    const std::vector<DistortionElement> clamped = clamped_elements();
    if (z.size() > 0 && count_flipped(clamped, z, unplaced) > 0) {
      unfold_locally(clamped, {}, patch_.backend, z, part(progress, 0.7, 0.9));
    }
    if (z.size() == 0 || count_flipped(clamped, z, unplaced) > 0) {
      // Limbs shrink below double precision.
      ComplexVector drawn =
          grid_embedding(single_, patch_.loops, 0, static_cast<int>(patch_.positions.rows()), part(progress, 0.9, 1));
      if (drawn.size() > 0) z = std::move(drawn);
    }
    return z;
  }

  void finish(FoldFreeMap& embedded) const {
    embedded.is_embedding = true;
    embedded.flipped = count_flipped(elements_, embedded.z, unplaced);
    embedded.is_locally_injective = embedded.flipped == 0 && goes_round_once(embedded.z);
  }

  /// The elements, each with a barrier. Degenerate triangles usually keep their vertices together and have no
  /// orientation. Here their height and size are clamped to give them one, since the embedding must not flip anywhere.
  std::vector<DistortionElement> clamped_elements() const {
    std::vector<DistortionElement> clamped = polled_copy(elements_);
    double area = 0;
    for (const DistortionElement& element : elements_) {
      if (element.barrier()) area += element.shape.area();
    }
    const double min_side = sliver * std::sqrt(area / static_cast<double>(elements_.size()));
    for_each_polled(clamped.size(), [&](std::size_t t) {
      DistortionElement& element = clamped[t];
      TriangleShape& shape = element.shape;
      if (element.barrier()) {
        // A metric may make it thinner than double precision allows for its image.
        shape = shape.clamped_to(insignificant);
        return;
      }
      element.regularization = 0;
      element.measured = true;
      const double height = shape.relative_height();
      shape = shape.clamped_to(sliver);
      const double side = std::sqrt(shape.area());
      // If it has no extent, local_isometric_frame made it equilateral, with side 1.
      const bool is_point = shape.clamped && height > 0.5;
      const double scale = is_point || side < min_side ? min_side / side : 1;
      shape = shape.scaled(scale);
      element.weight = shape.area() / area;
    });
    return clamped;
  }

  /// An embedding is far from its minimum.
  static DescentOptions from_afar(DistortionMeasure measure, double tolerance) {
    return {measure, tolerance, 3 * DescentOptions().max_factorizations, true};
  }

  std::optional<Descent> settle(const std::vector<DistortionElement>& elements, const Progress& progress,
                                ComplexVector& z) const {
    return relax(elements, from_afar({patch_.sizes}, 1e-3), progress, z);
  }

  std::optional<Descent> settle_apart(const Progress& progress, ComplexVector& z) const {
    return relax(clamped_elements(), from_afar({patch_.sizes}, 1e-5), progress, z, Boundary::apart);
  }

  /// Lowers the distortion without new folds. Empty if that failed; z is then unchanged.
  std::optional<Descent> relax(const std::vector<DistortionElement>& given, DescentOptions options,
                               const Progress& progress, ComplexVector& z, Boundary kept = Boundary::free) const {
    std::vector<DistortionElement> elements = polled_copy(given);
    const int flipped = count_flipped(elements, z, unplaced);
    const double factor = mean_scale_factor(elements, z);
    if (!(factor > 0) || !std::isfinite(factor)) return std::nullopt;
    ComplexVector relaxed = factor * z;
    std::optional<BoundaryBarrier> boundary;
    if (kept == Boundary::apart) {
      options.boundary = &boundary.emplace(BoundaryBarrier::around(patch_.loops, relaxed));
      options.max_factorizations *= 5;  // contacts slow the descent down
    }
    const Descent descent = descend(elements, {}, relaxed, patch_.backend, options, progress);
    if (!relaxed.allFinite() || count_flipped(elements, relaxed, unplaced) > flipped) return std::nullopt;
    z = std::move(relaxed);
    return descent;
  }

  const FoldFreePatch& patch_;
  const Progress& progress_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<int, 3>> single_;   ///< one split per quad
  std::vector<DistortionElement> elements_;  ///< of triangles_
};

}  // namespace

FoldFreeMap fold_free_map(const FoldFreePatch& patch, ComplexVector z, const Progress& progress) {
  return FoldFree(patch, progress).run(std::move(z));
}

}  // namespace spectral_conformal
