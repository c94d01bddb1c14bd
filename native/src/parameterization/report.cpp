#include "parameterization/report.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <locale>
#include <sstream>

#include "quality/turning_number.h"

namespace spectral_conformal {
namespace {

std::string count(int n, const char* one, const char* many) { return std::to_string(n) + " " + (n == 1 ? one : many); }

std::string five_digits(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(5) << value;
  return text.str();
}

}  // namespace

namespace {

/// Precondition: not Rejection::none.
std::string reason_of(const SpectralMap& map, bool pinned) {
  const std::string subject = pinned ? "The pinned map " : "The map ";
  switch (map.rejection) {
    case Rejection::none:
      break;
    case Rejection::not_factorized:
      return pinned ? "The pinned conformal energy is singular in double precision"
                    : "The conformal energy could not be factorised, even with a shift of " +
                          std::to_string(map.shift) + " of the boundary form";
    case Rejection::not_converged:
      return "The eigenvalue iteration did not converge";
    case Rejection::not_finite:
      return subject + "is not finite";
    case Rejection::collapsed:
      return subject + "shrinks the boundary to a point";
    case Rejection::unresolved:
      return pinned ? subject + "does not satisfy its equations in double precision"
                    : "The triangles differ so much in size or shape that double precision does not resolve the map";
    case Rejection::no_area:
      return subject + "has no positive area";
    case Rejection::winding:
      return describe_winding(map.turning_number);
  }
  return "";
}

std::string advice_for(const SpectralMap& map, const SolveOptions& options) {
  if (options.method == Method::lscm) {
    if (map.rejection == Rejection::not_factorized) {
      return "the island has degenerate triangles or pins that coincide in 3D; clean the mesh or pin other vertices.";
    }
    if (map.rejection == Rejection::collapsed) return "pin other vertices, or merge vertices by distance.";
    if (map.rejection == Rejection::no_area) return "use the spectral method, or pin other vertices.";
    return "clean up degenerate faces, cut an island that is very long, or pin other vertices.";
  }
  if (options.has_extenders_or_rigidity()) {
    const bool rigid = options.hole_rigidity.value_or(0) != 0;
    if (!options.has_extenders()) return "lower the hole rigidity.";
    return rigid ? "weaken or remove extenders, or lower the hole rigidity." : "weaken or remove extenders.";
  }
  if (map.rejection == Rejection::not_factorized) {
    return "the island has too many degenerate triangles; merge vertices by distance or dissolve degenerate faces.";
  }
  return "add seams that make the island flatter, or clean up degenerate faces.";
}

}  // namespace

SolveFailure failure_of(const SpectralMap& map, const SolveOptions& options) {
  std::string reason = reason_of(map, options.method == Method::lscm);
  if (map.attempts > 1) {
    reason += ", in " + std::to_string(map.attempts) + " attempts with different shifts and starts";
  }
  return {reason, advice_for(map, options)};
}

std::string describe_attempts(const SpectralMap& map, const SolveOptions& options) {
  std::string text;
  if (options.method != Method::lscm && map.attempts > 1) {
    text = "The first solve failed its checks and was repeated with a larger shift and another start. ";
  }
  if (std::abs(map.turning_number) != 1) text += describe_winding(map.turning_number) + ". ";
  return text;
}

std::string describe_rigidity(const std::optional<double>& asked, double used) {
  if (!asked || !(used < *asked)) return "";
  return "Hole rigidity lowered from " + five_digits(*asked) + " to " + five_digits(used) +
         ", which is what the island bears. ";
}

std::string describe_fallback(const FallbackMap& fallback, const SolveFailure& failure) {
  std::string what;
  switch (fallback.fallback) {
    case Fallback::none:
    case Fallback::unfolded:
    case Fallback::tutte_embedding:
      break;
    case Fallback::clamped_triangles:
      what = "triangles thinner than 1e-5 of their length clamped to that";
      break;
    case Fallback::other_boundary:
      what = fallback.boundary == BoundaryMeasure::vertex ? "the boundary form 'vertex'" : "the boundary form 'length'";
      break;
    case Fallback::other_weights:
      what = fallback.weights == Weights::uniform ? "the weights 'uniform'" : "the weights 'inverse_area'";
  }
  return failure.reason() + ": solved with " + what + " instead. ";
}

std::string describe_repairs(const Chart& chart, int clamped) {
  std::string text;
  if (chart.reversed_faces > 0) {
    text += count(chart.reversed_faces, "face", "faces") + " wound the other way: reoriented. ";
  }
  if (!chart.duplicates.empty()) {
    text += count(static_cast<int>(chart.duplicates.size()), "duplicate face", "duplicate faces") +
            ": placed on the first of the same vertices. ";
  }
  if (chart.self_intersecting_polygons > 0) {
    text += count(chart.self_intersecting_polygons, "self-intersecting polygon", "self-intersecting polygons") +
            ": split as a fan. ";
  }
  if (clamped > 0) text += count(clamped, "degenerate triangle", "degenerate triangles") + ": given a minimal height. ";
  return text;
}

std::string describe_relaxation(const IsometricMap& map) {
  if (map.flipped == 0) return "";
  return count(map.flipped, "triangle", "triangles") + " of the relaxed map could not be unfolded. ";
}

std::string describe_blend(double amount, RelaxationStatus relaxation, double before, double after) {
  constexpr double visible = 0.05;
  constexpr double little = 0.2;
  if (!(before > visible) || !std::isfinite(before) || !std::isfinite(after)) return "";
  if (after < before * (1 - little * amount)) return "";
  const std::string spread = five_digits(before) + " to " + five_digits(after) + " (log2)";
  std::string text = after < before ? "The area blend lowered the spread of scale by little, from " + spread
                                    : "The area blend did not lower the spread of scale, " + spread;
  switch (relaxation) {
    case RelaxationStatus::converged:
      break;
    case RelaxationStatus::factorization_limit:
      text += ": its relaxation stopped at its bound of factorisations";
      break;
    case RelaxationStatus::stalled:
      text += ": its relaxation was held up by flipped or degenerate triangles";
      break;
    case RelaxationStatus::indefinite_form:
    case RelaxationStatus::no_image_area:
    case RelaxationStatus::rejected:
      text += ": its relaxation failed";
  }
  return text + "; add seams, or clean up degenerate faces. ";
}

std::string describe_unfolding(const FoldFreeMap& map, const std::string& failure, double before, double after,
                               int turning_number, bool held) {
  std::string text;
  if (map.is_embedding && !map.came_apart_embedded) {
    text = failure.empty() ? "The folds left no room to unfold them" : failure;
    text += ": replaced by an embedding, relaxed without folding it; mean QC ";
    text += failure.empty() ? five_digits(before) + " -> " + five_digits(after) + ". " : five_digits(after) + ". ";
  } else if (map.flipped < map.flipped_before) {
    if (!failure.empty()) text = failure + ": ";
    text += count(map.flipped_before - map.flipped, "flipped triangle", "flipped triangles") + " unfolded; mean QC " +
            five_digits(before) + " -> " + five_digits(after) + ". ";
  }
  if (map.covers_itself) {
    text += "The island still covers itself somewhere; add seams. ";
  } else if (map.covered_itself) {
    text += map.came_apart_embedded
                ? "Parts that covered each other came apart in an embedding, relaxed without folding it"
                : "Parts that covered each other moved apart";
    text += "; mean QC " + five_digits(before) + " -> " + five_digits(after) + ". ";
  }
  if (map.flipped > 0) {
    text += count(map.flipped, "triangle", "triangles") +
            (held ? " could not be unfolded between the pins; move or remove pins. "
                  : " could not be unfolded in double precision; add seams that make the island flatter. ");
  } else if (!map.is_locally_injective) {
    text += std::abs(turning_number) == 1 ? "The map goes round an inner vertex more than once"
                                          : describe_winding(turning_number);
    text += (held ? "; move or remove pins. " : "; add seams. ");
  }
  return text;
}

std::string describe_unresolved(const ConformalEnergy& energy, const ComplexVector& z) {
  // Leaves three digits to the shape of a triangle.
  constexpr double min_fraction = 1e-13;
  const double min_length = min_fraction * (z.array() - z.mean()).abs().maxCoeff();
  int unresolved_triangles = 0;
  for (std::size_t t = 0; t + energy.n_virtual() < energy.triangles().size(); ++t) {
    const auto& [a, b, c] = energy.triangles()[t];
    const double longest = std::max(std::norm(z[b] - z[a]), std::norm(z[c] - z[a]));
    if (longest < min_length * min_length && !energy.shapes()[t].clamped) ++unresolved_triangles;
  }
  if (unresolved_triangles == 0) return "";
  return count(unresolved_triangles, "triangle shrinks", "triangles shrink") +
         " below what double precision resolves; add seams that make the island flatter. ";
}

}  // namespace spectral_conformal
