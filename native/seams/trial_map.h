#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "mesh/charts.h"
#include "spectral_conformal/parameterize.h"
#include "spectral_conformal/progress.h"

namespace spectral_conformal {

/// Pieces with more vertices are first searched on coarse copies, the coarsest with half as many, and get fewer trials.
constexpr int small_piece = 2000;
/// Larger pieces are searched one at a time, because their maps need much memory, and with as few solves as possible.
/// On a smaller piece, a sword of 22,000 vertices, the fewer solves saved nothing and left the energy above its limit.
constexpr int large_piece = 60000;

/// A value that is found when it is first asked for, by any thread. A copy, which may be changed, finds its own.
template <class T>
class FoundOnce {
 public:
  FoundOnce() = default;
  FoundOnce(const FoundOnce& /*other*/) {}
  FoundOnce& operator=(const FoundOnce&) = delete;
  ~FoundOnce() = default;

  template <class Find>
  const T& get(const Find& find) const {
    std::call_once(is_found_, [&] { value_ = find(); });
    return value_;
  }

 private:
  mutable std::once_flag is_found_;
  mutable T value_{};
};

/// A chart with its spectral map and the distortion of each face, which is empty if not solved.
struct TrialMap {
  Chart chart;
  bool solved = false;
  ComplexVector z;                      ///< (V,) as Solver::solve returns it, scaled to the area in 3D
  std::vector<double> area;             ///< per face of the chart, in 3D
  std::vector<double> log2_scale;       ///< per face, log2 of the root of (area in the plane / area in 3D), within +-16
  std::vector<double> qc;               ///< per face, area-weighted mean of its triangles, each at most 1000
  std::vector<int> flipped;             ///< faces with a flipped triangle, as indices into the chart's, ascending
  std::uint64_t digest = 0;             ///< of the chart
  FoundOnce<std::vector<int>> defects;  ///< see defective_faces
  FoundOnce<double> side;               ///< see longer_side
};

/// Solves a chart of `mesh`. `fallbacks` is that of SolveOptions: a map that needs one calls for a cut anyway, and
/// takes long. If the chart cannot be solved, `solved` is false. Throws Cancelled.
TrialMap solve_trial_map(const PolygonMesh& mesh, Chart chart, const PatchOptions& options, bool fallbacks,
                         const Progress& progress);

/// The faces that must be cut before texturing: flipped, or covering part of another face. Indices into the chart's
/// faces, ascending; empty if the chart is not solved. Found once per map; several threads may ask at once.
std::vector<int> defective_faces(const TrialMap& mapped);

/// The longer side of the smallest rectangle around the map; 0 if the chart is not solved. Found once per map; several
/// threads may ask at once.
double longer_side(const TrialMap& mapped);

/// The maps of the charts of a mesh. Trials that leave a chart unchanged share its map.
using TrialMaps = std::vector<std::shared_ptr<const TrialMap>>;

/// A chart whose map is looked up.
struct ChartKey {
  explicit ChartKey(const Chart& sought);
  const Chart& chart;
  std::uint64_t digest;  ///< of its faces and vertices: most charts differ in it, and few numbers have to be compared
};

/// An order of maps by their charts, all of one piece. Every cut duplicates vertices or changes the number of loops, so
/// charts with equal faces, vertices, triangles and numbers of loops are equal.
struct ChartOrder {
  using is_transparent = void;
  template <class A, class B>
  bool operator()(const A& a, const B& b) const {
    const std::uint64_t one = of(a).digest;
    const std::uint64_t other = of(b).digest;
    return one != other ? one < other : precedes(of(a).chart, of(b).chart);
  }

 private:
  static const ChartKey& of(const ChartKey& key) { return key; }
  static const TrialMap& of(const std::shared_ptr<const TrialMap>& mapped) { return *mapped; }
  static bool precedes(const Chart& a, const Chart& b);
};

/// Maps that need not be computed again: the first one added for each chart.
using KnownMaps = std::set<std::shared_ptr<const TrialMap>, ChartOrder>;

/// The distortion of several charts together.
struct MapQuality {
  bool solved = true;            ///< all charts are; otherwise only the area and the mean QC follow
  double median_log2_scale = 0;  ///< weighted by area
  double within_limit = 1;       ///< fraction of the area whose scale is within a factor of the median
  double mean_qc = 1;            ///< weighted by area
  /// Area-weighted mean of the faces' symmetric Dirichlet energies s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2, with the singular
  /// values s1, s2 at the median scale: 4 for an isometry. Beyond a scale of 2 or a QC of 4, it grows with the square
  /// of the logarithm (with_inverse). Otherwise the astronomical energy of a sliver or of the end of a long limb would
  /// outweigh all else.
  double energy = 4;
  double rms_excess = 0;  ///< root mean square of the faces' energies above 4
  double shear = 0;       ///< the part of energy - 4 due to angles, which remains at equal scale
  double area = 0;

  /// The energy above that of an isometry; infinite where a chart is not solved.
  double distortion() const;
};

/// ratio + 1 / ratio, continued smoothly beyond 4 and 1 / 4 by a parabola in log(ratio). The symmetric Dirichlet energy
/// is the value for s1 / s2 times the value for s1 s2.
double with_inverse(double ratio);

/// The integral over a chart of the squares of its faces' energies above 4, at this median scale: its part of
/// MapQuality::rms_excess.
double squared_excess(const TrialMap& mapped, double median_log2_scale);

/// `scale_limit` is the factor of within_limit, above 1.
MapQuality map_quality(const TrialMaps& charts, double scale_limit);

}  // namespace spectral_conformal
