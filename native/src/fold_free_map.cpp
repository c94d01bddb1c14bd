#include "spectral_conformal/fold_free_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "spectral_conformal/convex_embedding.h"
#include "spectral_conformal/distortion_descent.h"
#include "spectral_conformal/local_unfolding.h"
#include "spectral_conformal/turning_number.h"

namespace spectral_conformal {
namespace {

constexpr double pi = 3.14159265358979323846;

class FoldFree {
 public:
  FoldFree(const FoldFreePatch& patch, const Progress& progress) : patch_(patch), progress_(progress) {
    const ConformalEnergy& energy = patch.energy;
    const std::size_t n = energy.triangles().size() - energy.n_virtual();
    const auto end = static_cast<std::ptrdiff_t>(n);
    triangles_.assign(energy.triangles().begin(), energy.triangles().begin() + end);
    const std::vector<TriangleShape> shapes(energy.energy_shapes().begin(), energy.energy_shapes().begin() + end);
    const std::vector<double> coverage(energy.coverage().begin(), energy.coverage().begin() + end);
    elements_ = distortion_elements(triangles_, shapes, coverage, 0);
    for (std::size_t t = 0; t < n; ++t) {
      single_.push_back(triangles_[t]);
      if (coverage[t] == 1.0) continue;
      // triangulate_polygon puts the four triangles of a quad's two splits in a row.
      single_.push_back(triangles_[t + 1]);
      elements_[t + 2].measured = elements_[t + 3].measured = false;
      t += 3;
    }
    n_vertices_ = 0;
    for (const auto& triangle : triangles_)
      n_vertices_ = std::max(n_vertices_, 1 + *std::max_element(triangle.begin(), triangle.end()));
  }

  FoldFreeMap run(ComplexVector given) {
    FoldFreeMap result;
    result.z = std::move(given);
    if (result.z.size() > 0) {
      result.folded_before = result.folded = folded(result.z);
      if (result.folded > 0) {
        const Progress first = part(progress_, 0, 0.3);
        result.folded = unfold_locally(elements_, patch_.held, patch_.backend, result.z, first);
      }
      result.is_locally_injective = result.folded == 0 && goes_round_once(result.z);
      if (result.is_locally_injective || !patch_.held.empty()) return result;
    }
    FoldFreeMap embedded = embed();
    embedded.folded_before = result.folded_before;
    if (result.z.size() > 0 && !embedded.is_locally_injective) return result;
    return embedded;
  }

 private:
  int folded(const ComplexVector& z) const {
    const std::vector<bool> each = folded_elements(elements_, z);
    return static_cast<int>(std::count(each.begin(), each.end(), true));
  }

  /// Whether the triangles go round every inner vertex once, and the outer loop round the map.
  bool goes_round_once(const ComplexVector& z) const {
    const std::vector<double> whole(single_.size(), 1.0);
    if (std::abs(turning_number(patch_.loops.front(), single_, whole, z)) != 1) return false;
    std::vector<double> angle(static_cast<std::size_t>(z.size()), 0);
    for (const auto& triangle : single_) {
      for (int k = 0; k < 3; ++k) {
        const Complex next = z[triangle[(k + 1) % 3]] - z[triangle[k]];
        const Complex previous = z[triangle[(k + 2) % 3]] - z[triangle[k]];
        angle[triangle[k]] += std::arg(std::conj(next) * previous);
      }
    }
    for (const BoundaryLoop& loop : patch_.loops) {
      for (const int v : loop) angle[v] = 0;
    }
    return std::none_of(angle.begin(), angle.end(), [](double sum) { return sum > 3 * pi; });
  }

  FoldFreeMap embed() {
    FoldFreeMap result;
    result.is_embedding = true;
    result.z = convex_embedding(single_, patch_.loops, 0, patch_.positions.topRows(n_vertices_), patch_.backend,
                                part(progress_, 0.3, 0.5));
    if (folded(result.z) > 0) unfold_locally(elements_, {}, patch_.backend, result.z, part(progress_, 0.5, 0.6));
    relax(DistortionMeasure::symmetric_dirichlet, 1e-2, part(progress_, 0.6, 0.8), result.z);
    relax(DistortionMeasure::conformal, 1e-3, part(progress_, 0.8, 1), result.z);
    result.folded = folded(result.z);
    result.is_locally_injective = result.folded == 0 && goes_round_once(result.z);
    return result;
  }

  /// Lessens the distortion without a new fold.
  void relax(DistortionMeasure measure, double tolerance, const Progress& progress, ComplexVector& z) const {
    constexpr int max_factorizations = 60;
    std::vector<DistortionElement> elements = elements_;
    const double factor = mean_scale_factor(elements, z);
    if (!(factor > 0) || !std::isfinite(factor)) return;
    ComplexVector relaxed = factor * z;
    descend(elements, {}, relaxed, patch_.backend, {measure, tolerance, max_factorizations, true}, progress);
    if (relaxed.allFinite() && folded(relaxed) <= folded(z)) z = std::move(relaxed);
  }

  const FoldFreePatch& patch_;
  const Progress& progress_;
  int n_vertices_ = 0;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<int, 3>> single_;   ///< of a quad the first split only
  std::vector<DistortionElement> elements_;  ///< of triangles_
};

}  // namespace

FoldFreeMap fold_free_map(const FoldFreePatch& patch, ComplexVector z, const Progress& progress) {
  return FoldFree(patch, progress).run(std::move(z));
}

}  // namespace spectral_conformal
