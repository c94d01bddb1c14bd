#include "parameterization/solve_report.h"

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

std::string describe_repairs(const Chart& chart, int clamped) {
  std::string text;
  if (chart.reversed_faces > 0) {
    text += count(chart.reversed_faces, "face", "faces") + " wound the other way: turned. ";
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

std::string describe_unfolding(const FoldFreeMap& map, const std::string& failure, double before, double after,
                               int turning_number, bool held) {
  std::string text;
  if (map.is_embedding) {
    text = failure.empty() ? "The folds left no room to unfold them" : failure;
    text += ": replaced by an embedding, relaxed without folding it; mean QC ";
    text += failure.empty() ? five_digits(before) + " -> " + five_digits(after) + ". " : five_digits(after) + ". ";
  } else if (map.folded < map.folded_before) {
    text = count(map.folded_before - map.folded, "folded triangle", "folded triangles") + " unfolded; mean QC " +
           five_digits(before) + " -> " + five_digits(after) + ". ";
  }
  if (map.folded > 0) {
    text += count(map.folded, "triangle", "triangles") +
            (held ? " could not be unfolded between the pins; move or remove pins. "
                  : " could not be unfolded in double precision; add seams that make the patch flatter. ");
  } else if (!map.is_locally_injective) {
    text += std::abs(turning_number) == 1 ? "The map goes round an inner vertex more than once"
                                          : describe_winding(turning_number);
    text += (held ? "; move or remove pins. " : "; add seams. ");
  }
  return text;
}

std::string describe_unresolved(const ConformalEnergy& energy, const ComplexVector& z) {
  // Leaves three digits to the shape of a triangle.
  constexpr double least_part = 1e-13;
  const double least = least_part * (z.array() - z.mean()).abs().maxCoeff();
  int unresolved_triangles = 0;
  for (std::size_t t = 0; t + energy.n_virtual() < energy.triangles().size(); ++t) {
    const auto& [a, b, c] = energy.triangles()[t];
    const double longest = std::max(std::norm(z[b] - z[a]), std::norm(z[c] - z[a]));
    if (longest < least * least && !energy.shapes()[t].clamped) ++unresolved_triangles;
  }
  if (unresolved_triangles == 0) return "";
  return count(unresolved_triangles, "triangle shrinks", "triangles shrink") +
         " below what double precision resolves; add seams that make the patch flatter. ";
}

}  // namespace spectral_conformal
