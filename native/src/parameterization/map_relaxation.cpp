#include "spectral_conformal/map_relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/binary_unit.h"
#include "geometry/signed_area.h"
#include "geometry/tolerances.h"
#include "graph/disjoint_sets.h"
#include "graph/numbering.h"
#include "injective/local_unfolding.h"
#include "mesh/charts.h"
#include "quality/flips.h"
#include "quality/overlap.h"
#include "relaxation/descent.h"
#include "relaxation/equation_projection.h"
#include "relaxation/sliding_border.h"

namespace spectral_conformal {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// The charts of triangles.
std::vector<Chart> charts_of(const Eigen::Ref<const Positions>& positions, const Triangles& triangles) {
  std::vector<int> offsets(triangles.size() + 1);
  for (std::size_t t = 0; t <= triangles.size(); ++t) offsets[t] = 3 * static_cast<int>(t);
  PolygonMesh mesh;
  mesh.positions = positions.data();
  mesh.n_vertices = static_cast<int>(positions.rows());
  mesh.face_offsets = offsets.data();
  mesh.n_faces = static_cast<int>(triangles.size());
  mesh.corner_vertices = triangles.empty() ? nullptr : triangles.front().data();
  return build_charts(mesh).charts;
}

/// The numbers of overlapping triangles of an island.
struct Overlaps {
  int all = 0;      ///< however little
  int visible = 0;  ///< as find_map_defects counts: within a chart, at the resolution of stored UVs

  bool exceed(const Overlaps& other) const { return all > other.all || visible > other.visible; }
};

/// One island, in coordinates in which it has its area in 3D, in a unit of its own, and is counterclockwise.
class Island {
 public:
  /// triangles and charts: of the island, on the indices into its `vertices`.
  Island(std::vector<int> vertices, Triangles triangles, std::vector<Chart> charts)
      : vertices_(std::move(vertices)), all_(std::move(triangles)), charts_(std::move(charts)) {}

  /// shapes, in any unit, and weights: per triangle; fixed: per vertex of the island, or empty; equations: on its
  /// vertices; all_fixed, gets what the border fixes, and z: of the whole map.
  void begin(const std::vector<TriangleShape>& shapes, const std::vector<double>& weights, std::vector<char> fixed,
             LinearEquations equations, const MapRelaxationOptions& options, const Progress& progress,
             std::vector<char>& all_fixed, ComplexVector& z) {
    fixed_ = std::move(fixed);
    for (const int v : vertices_) {
      image_unit_.include(z[v].real());
      image_unit_.include(z[v].imag());
    }
    const ComplexVector image = image_unit_.scaled(1) * part_of(z, vertices_);
    double whole_area = 0;
    for (std::size_t t = 0; t < all_.size(); ++t) {
      const auto& [a, b, c] = all_[t];
      if (shapes[t].clamped) continue;
      area_ += shapes[t].area();
      whole_area += signed_area(image[a], image[b], image[c]);
    }
    scale_ = std::sqrt(area_ / std::abs(whole_area));
    is_mirrored_ = whole_area < 0;
    is_collapsed_ = area_ > 0 && !(std::isfinite(scale_) && scale_ > 0);
    if (is_collapsed_) scale_ = 1;
    ComplexVector own = scale_ * (image.array() - image[0]).matrix();
    if (is_mirrored_) own = own.conjugate().eval();
    if (!(area_ > 0) || is_collapsed_) {
      for (std::size_t t = 0; t < all_.size(); ++t) {
        if (!shapes[t].clamped && !is_positive(all_[t], own, unplaced)) ++flipped_;
      }
      return;
    }

    std::vector<BoundaryLoop> border = boundary_loops();
    const std::vector<char> slides = bind_border(border, own, options.border, equations);
    for (std::size_t v = 0; v < fixed_.size(); ++v) all_fixed[vertices_[v]] = fixed_[v];

    // Triangles that cannot move are left out.
    Triangles moving;
    std::vector<TriangleShape> their_shapes;
    std::vector<double> their_weights;
    for (std::size_t t = 0; t < all_.size(); ++t) {
      if (is_held(all_[t])) {
        const auto& [a, b, c] = all_[t];
        if (!shapes[t].clamped) held_area_ += signed_area(own[a], own[b], own[c]);
        if (!shapes[t].clamped && !is_positive(all_[t], own, unplaced)) ++flipped_and_held_;
        continue;
      }
      moving.push_back(all_[t]);
      their_shapes.push_back(shapes[t]);
      their_weights.push_back(weights.empty() ? 1 : weights[t]);
      if (!shapes[t].clamped) weight_ += their_weights.back() * shapes[t].area();
    }
    if (!(weight_ > 0) || !std::isfinite(weight_)) return;
    const std::vector<TriangleWeight> whole(moving.size());
    std::vector<DistortionElement> elements = distortion_elements(moving, their_shapes, whole, 0);
    double sum = 0;
    for (std::size_t t = 0; t < moving.size(); ++t) sum += (elements[t].weight *= their_weights[t]);
    for (DistortionElement& element : elements) element.weight /= sum;

    map_ = own;
    measure_ = {options.sizes};
    if (!has_free_vertex(border)) border.clear();
    take_part(elements, border, equations);
    own = part_of(map_, part_);
    std::vector<char> slides_in_part;
    for (const int v : part_) slides_in_part.push_back(slides[v]);
    sliding_ = SlidingBorder::along(border, own, slides_in_part);
    is_free_ = fixed_.empty() && equations.empty() && sliding_.empty();
    first_area_ = image_area(elements, own);
    overlaps_ = count_overlaps(own, z);
    flipped_ = count_flipped(elements, own, unplaced);
    if (options.fold_free && flipped_ > 0) {
      given_ = own;
      unfold_locally(elements, bound(equations, slides_in_part), options.backend, own, progress);
      if (accept(elements, own, z)) write(own, z);
    }
    energy_before_ = energy_of(elements, part_of(map_, part_));
    // Areas whose inverse squares double precision cannot hold.
    if (!std::isfinite(energy_before_)) {
      is_collapsed_ = true;
      flipped_ = std::max(flipped_, count_unbounded(elements));
      return;
    }
    has_converged_ = false;
    elements_ = std::move(elements);
    backend_ = options.backend;
    options_.measure = measure_;
    options_.tolerance = options.tolerance;
    options_.max_factorizations = std::numeric_limits<int>::max();
    options_.keep_all_barriers = true;
    // Angles alone have no scale.
    if (options.sizes > 0) options_.area = area_;
    options_.area_elsewhere = held_area_;
    border_loops_ = std::move(border);
    if (!sliding_.empty()) options_.sliding = &sliding_;
    if (!equations.empty()) options_.equations = &projection(std::move(equations), options.backend);
    start(std::move(own));
    if (!std::isfinite(descent_->result().energy)) descent_.reset();
  }

  bool can_advance() const { return descent_ && !has_ended_; }

  /// Takes a step and writes it into the map z, unless the map would have more flipped or overlapping triangles. A few
  /// later steps may still remove these.
  void advance(const Progress& progress, ComplexVector& z) {
    // Of bad starts, triangles overlap on their way around each other.
    constexpr int max_rejected = 50;
    const bool goes_on = descent_->advance(progress);
    const ComplexVector own = is_free_ ? at_first_area(descent_->z()) : descent_->z();
    if (accept(descent_->elements(), own, z)) {
      n_rejected_ = 0;
      const int taken = descent_->result().iterations - std::exchange(steps_of_descent_, descent_->result().iterations);
      steps_ += taken;
      if (taken > 0) write(own, z);
    } else {
      ++n_rejected_;
    }
    if (goes_on && n_rejected_ < max_rejected) return;
    // The unfolded map may leave less room for the last flips than the given one.
    if (flipped_ > 0 && given_.size() > 0) {
      must_improve_ = true;
      start(std::exchange(given_, {}));
      return;
    }
    has_ended_ = true;
    has_converged_ = n_rejected_ == 0 && descent_->result().status == RelaxationStatus::converged;
  }

  /// In the unit of the shapes.
  double weight() const { return is_collapsed_ ? 0 : weight_; }
  double energy_before() const { return energy_before_; }
  double energy() const { return steps_ > 0 ? energy_of(elements_, part_of(map_, part_)) : energy_before_; }
  int steps() const { return steps_; }
  int flipped() const { return flipped_ + flipped_and_held_; }
  bool is_collapsed() const { return is_collapsed_; }
  bool has_converged() const { return !is_collapsed_ && has_converged_; }

 private:
  bool is_held(const std::array<int, 3>& triangle) const {
    if (fixed_.empty()) return false;
    return std::all_of(triangle.begin(), triangle.end(), [&](int v) { return fixed_[v] != 0; });
  }
  bool has_free_vertex(const std::vector<BoundaryLoop>& loops) const {
    return std::any_of(loops.begin(), loops.end(), [&](const BoundaryLoop& loop) {
      return fixed_.empty() || std::any_of(loop.begin(), loop.end(), [&](int v) { return !fixed_[v]; });
    });
  }

  /// The border, on the island's vertices.
  std::vector<BoundaryLoop> boundary_loops() const {
    std::vector<BoundaryLoop> border;
    for (const Chart& chart : charts_) {
      for (BoundaryLoop loop : chart.boundary_loops) {
        for (int& v : loop) v = chart.vertices[v];
        border.push_back(std::move(loop));
      }
    }
    return border;
  }

  /// Fixes the vertices of the border that its option holds. Returns those that slide, per vertex: but those of
  /// equations, which get another each where the border is straight, relative to a fixed vertex.
  std::vector<char> bind_border(const std::vector<BoundaryLoop>& border, const ComplexVector& own, Border option,
                                LinearEquations& equations) {
    std::vector<char> slides(vertices_.size(), 0);
    if (option == Border::free) return slides;
    std::vector<char> is_bound(vertices_.size(), 0);
    for (const int c : equations.coordinate) is_bound[c / 2] = 1;
    for (const auto& [c, value] : equations.held) is_bound[c / 2] = 1;
    fixed_.resize(vertices_.size(), 0);
    const std::vector<BorderTurn> turns = border_turns(border, own);
    std::vector<std::pair<int, Complex>> straight;  // of equations, with the direction of the border
    for (const BoundaryLoop& loop : border) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const int v = loop[i];
        if (fixed_[v]) continue;
        const bool can_slide = option == Border::sliding && turns[v] != BorderTurn::corner;
        if (can_slide && is_bound[v] && turns[v] == BorderTurn::straight) {
          straight.emplace_back(v, own[loop[(i + 1) % loop.size()]] - own[loop[i > 0 ? i - 1 : loop.size() - 1]]);
        } else {
          (can_slide && !is_bound[v] ? slides : fixed_)[v] = 1;
        }
      }
    }
    const int anchor = static_cast<int>(std::find(fixed_.begin(), fixed_.end(), 1) - fixed_.begin());
    if (anchor == static_cast<int>(fixed_.size())) {
      for (const auto& [v, along] : straight) fixed_[v] = 1;
    } else {
      for (const auto& [v, along] : straight) {
        // Equations are those of the given map.
        const Complex normal = Complex(-along.imag(), is_mirrored_ ? -along.real() : along.real()) / std::abs(along);
        equations.add({{2 * v, normal.real()},
                       {2 * v + 1, normal.imag()},
                       {2 * anchor, -normal.real()},
                       {2 * anchor + 1, -normal.imag()}});
      }
    }
    if (std::find(fixed_.begin(), fixed_.end(), 1) == fixed_.end()) fixed_.clear();
    return slides;
  }

  /// Starts a descent.
  void start(ComplexVector own) {
    descent_.reset();
    border_.reset();
    if (!border_loops_.empty()) {
      options_.boundary =
          &border_.emplace(BoundaryBarrier::around(border_loops_, own, BoundaryBarrier::Contacts::ignored));
    }
    descent_.emplace(StepwiseDescent::begin(elements_, fixed_, std::move(own), backend_, options_));
    n_rejected_ = steps_of_descent_ = 0;
  }

  /// Whether a map, once written into z, has no more flipped and overlapping triangles than the present one, and fewer
  /// flipped ones where its energy is higher or a second descent is on its way; these numbers are then the present
  /// ones.
  bool accept(const std::vector<DistortionElement>& elements, const ComplexVector& own, const ComplexVector& z) {
    const int flipped = count_flipped(elements, own, unplaced);
    if (flipped > flipped_) return false;
    if (must_improve_ && flipped == flipped_) return false;
    // The descent may shrink flipped triangles toward points, which all others pay for.
    const bool may_rise = flipped == 0 || flipped < flipped_;
    if (!may_rise && energy_of(elements, own) > energy_of(elements, part_of(map_, part_))) return false;
    // Without flips, overlaps and contacts, the barriers keep it so.
    const bool has_defects = overlaps_.all > 0 || flipped_ > 0 || flipped_and_held_ > 0;
    const bool is_kept = !has_defects && !(border_ && border_->ignores_contacts());
    const Overlaps overlaps = is_kept ? Overlaps() : count_overlaps(own, z);
    if (overlaps.exceed(overlaps_)) return false;
    flipped_ = flipped;
    overlaps_ = overlaps;
    must_improve_ = false;
    return true;
  }

  /// At which a map has the area of the surface.
  double scale_of(const std::vector<DistortionElement>& elements, const ComplexVector& own) const {
    return std::sqrt(area_ / std::abs(held_area_ + image_area(elements, own)));
  }

  /// The documented energy of a map.
  double energy_of(const std::vector<DistortionElement>& elements, const ComplexVector& own) const {
    const double scale = scale_of(elements, own);
    return std::isfinite(scale) ? measured_distortion(elements, measure_, scale * own) : infinity;
  }

  /// The triangles with an infinite energy in the present map.
  int count_unbounded(const std::vector<DistortionElement>& elements) const {
    ComplexVector own = part_of(map_, part_);
    own *= scale_of(elements, own);
    return static_cast<int>(std::count_if(elements.begin(), elements.end(), [&](DistortionElement element) {
      element.weight = 1;
      return element.measured && !std::isfinite(measured_distortion({element}, measure_, own));
    }));
  }

  /// A map with the area that the given one has, about the same middle: others beside it keep their density.
  ComplexVector at_first_area(const ComplexVector& own) const {
    const double scale = std::sqrt(first_area_ / image_area(elements_, own));
    if (!(scale > 0) || !std::isfinite(scale)) return own;
    const Complex middle = own.mean();
    return ((own.array() - middle) * scale + middle).matrix();
  }

  /// The fixed vertices, those of equations and those that slide.
  std::vector<char> bound(const LinearEquations& equations, const std::vector<char>& slides) const {
    if (equations.empty() && sliding_.empty()) return fixed_;
    std::vector<char> result = slides;
    for (std::size_t v = 0; v < fixed_.size(); ++v) result[v] |= fixed_[v];
    for (const int c : equations.coordinate) result[c / 2] = 1;
    for (const auto& [c, value] : equations.held) result[c / 2] = 1;
    return result;
  }

  const EquationProjection& projection(LinearEquations equations, FactorizationBackend backend) {
    for (std::size_t k = 0; is_mirrored_ && k < equations.coordinate.size(); ++k) {
      if (equations.coordinate[k] % 2 == 1) equations.coefficient[k] *= -1;
    }
    for (int v = 0; v < static_cast<int>(fixed_.size()); ++v) {
      if (!fixed_[v]) continue;
      equations.held.emplace_back(2 * v, 0.0);
      equations.held.emplace_back(2 * v + 1, 0.0);
    }
    return equations_.emplace(EquationProjection::of(std::move(equations), static_cast<int>(part_.size()), backend));
  }

  /// Renumbers the vertices of the elements, of the border and of the equations, so that the descent has no others:
  /// held vertices far from all that moves cost neither memory nor time.
  void take_part(std::vector<DistortionElement>& elements, std::vector<BoundaryLoop>& border,
                 LinearEquations& equations) {
    std::vector<int> number(vertices_.size(), -1);
    for (const DistortionElement& element : elements) {
      for (const int v : element.corners) number[v] = 0;
    }
    for (const BoundaryLoop& loop : border) {
      for (const int v : loop) number[v] = 0;
    }
    for (const int c : equations.coordinate) number[c / 2] = 0;
    for (const auto& [c, value] : equations.held) number[c / 2] = 0;
    part_ = number_marked(number);
    std::vector<char> fixed;
    for (const int v : part_) {
      if (!fixed_.empty()) fixed.push_back(fixed_[v]);
    }
    fixed_ = std::move(fixed);
    for (DistortionElement& element : elements) {
      for (int& v : element.corners) v = number[v];
    }
    for (BoundaryLoop& loop : border) {
      for (int& v : loop) v = number[v];
    }
    equations = equations.renumbered(number);
  }

  static ComplexVector part_of(const ComplexVector& map, const std::vector<int>& vertices) {
    ComplexVector part(static_cast<Eigen::Index>(vertices.size()));
    for (Eigen::Index i = 0; i < part.size(); ++i) part[i] = map[vertices[i]];
    return part;
  }

  /// Calls visit(vertex of the island, its displacement in the unit of z) for the vertices that move.
  template <class Visit>
  void for_each_displacement(const ComplexVector& own, const Visit& visit) const {
    for (Eigen::Index i = 0; i < own.size(); ++i) {
      const int v = part_[i];
      if (own[i] == map_[v]) continue;
      const Complex displacement = image_unit_.length_of((own[i] - map_[v]) / scale_);
      visit(v, is_mirrored_ ? std::conj(displacement) : displacement);
    }
  }

  /// The overlapping triangles of each chart.
  int count_within_charts(const ComplexVector& map, double resolution) const {
    std::size_t n = 0;
    for (const Chart& chart : charts_) {
      const ComplexVector z =
          positively_oriented(chart.triangles, chart.triangle_weights, part_of(map, chart.vertices));
      n += overlapping_faces(chart, z, resolution).size();
    }
    return static_cast<int>(n);
  }

  /// Those of a map, and of z with it.
  Overlaps count_overlaps(const ComplexVector& own, const ComplexVector& z) const {
    ComplexVector map = map_;
    for (Eigen::Index i = 0; i < own.size(); ++i) map[part_[i]] = own[i];
    Overlaps result;
    if (charts_.size() == 1) {
      result.all = count_within_charts(map, 0);
    } else {
      const std::vector<bool> overlapping = overlapping_triangles(all_, map);
      result.all = static_cast<int>(std::count(overlapping.begin(), overlapping.end(), true));
    }
    if (result.all == 0) return result;
    ComplexVector written = part_of(z, vertices_);
    for_each_displacement(own, [&](int v, Complex displacement) { written[v] += displacement; });
    result.visible = count_within_charts(written, stored_resolution);
    return result;
  }

  /// Adds the displacements of the vertices that moved; the others keep every bit.
  void write(const ComplexVector& own, ComplexVector& z) {
    for_each_displacement(own, [&](int v, Complex displacement) { z[vertices_[v]] += displacement; });
    for (Eigen::Index i = 0; i < own.size(); ++i) map_[part_[i]] = own[i];
  }

  std::vector<int> vertices_;
  Triangles all_;
  std::vector<Chart> charts_;
  std::vector<int> part_;    ///< the island's vertices in the descent
  std::vector<char> fixed_;  ///< of these; at first of all vertices
  BinaryUnit image_unit_;    ///< of the given map
  double scale_ = 0;         ///< of the coordinates over the given map in its unit
  bool is_mirrored_ = false;
  bool is_collapsed_ = false;  ///< without image area that double precision can hold
  bool is_free_ = false;       ///< whether nothing is fixed, constrained or slides
  double area_ = 0;            ///< in 3D
  double held_area_ = 0;       ///< image area of the triangles that cannot move
  double first_area_ = 0;      ///< that of the others, of the given map
  ComplexVector map_;          ///< the present positions of all vertices, in these coordinates
  double weight_ = 0;
  int flipped_ = 0;  ///< of the triangles that move
  int flipped_and_held_ = 0;
  Overlaps overlaps_;
  DistortionMeasure measure_;
  double energy_before_ = 0;
  int steps_ = 0;
  int steps_of_descent_ = 0;   ///< of these, in the present descent
  int n_rejected_ = 0;         ///< steps since the last that was written
  bool must_improve_ = false;  ///< whether a second descent has not yet removed flips
  bool has_ended_ = false;
  bool has_converged_ = true;
  std::vector<DistortionElement> elements_;  ///< those that move, as given to a descent
  ComplexVector given_;                      ///< the start of a second descent, or empty
  FactorizationBackend backend_ = FactorizationBackend::automatic;
  DescentOptions options_;
  std::vector<BoundaryLoop> border_loops_;
  std::optional<BoundaryBarrier> border_;
  SlidingBorder sliding_;
  std::optional<EquationProjection> equations_;
  std::optional<StepwiseDescent> descent_;
};

}  // namespace

struct MapRelaxation::State {
  ComplexVector z;
  std::vector<char> fixed;
  std::vector<Island> islands;
  std::vector<BinaryUnit> units;  ///< of the islands' positions
  BinaryUnit unit;                ///< of all positions

  /// The mean over the islands.
  template <class Energy>
  double mean(const Energy& energy_of) const {
    double sum = 0;
    double weight = 0;
    for (std::size_t k = 0; k < islands.size(); ++k) {
      const double own = std::ldexp(islands[k].weight(), 2 * (units[k].exponent() - unit.exponent()));
      if (!(own > 0)) continue;
      sum += own * energy_of(islands[k]);
      weight += own;
    }
    if (weight > 0) return sum / weight;
    const bool is_collapsed =
        std::any_of(islands.begin(), islands.end(), [](const Island& i) { return i.is_collapsed(); });
    return is_collapsed ? infinity : 0;
  }
};

MapRelaxation MapRelaxation::begin(const Eigen::Ref<const Positions>& positions,
                                   const std::vector<std::array<int, 3>>& triangles, ComplexVector z,
                                   const std::vector<char>& fixed, const std::vector<double>& weights,
                                   const MapRelaxationOptions& options, const Progress& progress) {
  auto state = std::make_unique<State>();
  const CancellationScope scope(progress, "relax");
  state->z = std::move(z);
  const auto n = static_cast<int>(state->z.size());
  state->fixed = fixed;
  state->fixed.resize(static_cast<std::size_t>(n), 0);
  DisjointSets sets(n);
  for (const auto& [a, b, c] : triangles) {
    sets.unite(a, b);
    sets.unite(a, c);
  }
  std::vector<int> island(static_cast<std::size_t>(n), -1);  // of a set's root, and then of each vertex
  int n_islands = 0;
  for (const auto& triangle : triangles) {
    int& of_root = island[sets.find(triangle[0])];
    if (of_root < 0) of_root = n_islands++;
  }
  std::vector<std::vector<int>> vertices(static_cast<std::size_t>(n_islands));
  std::vector<std::vector<int>> members(static_cast<std::size_t>(n_islands));
  std::vector<int> index(static_cast<std::size_t>(n));
  for (int v = 0; v < n; ++v) {
    const int k = island[v] = island[sets.find(v)];
    if (k < 0) continue;
    index[v] = static_cast<int>(vertices[k].size());
    vertices[k].push_back(v);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) members[island[triangles[t][0]]].push_back(static_cast<int>(t));
  std::vector<LinearEquations> equations = options.constraints.by_part(island, index, n_islands);
  std::vector<std::vector<Chart>> charts(static_cast<std::size_t>(n_islands));
  for (Chart& chart : charts_of(positions, triangles)) {
    const int k = island[chart.vertices.front()];
    for (int& v : chart.vertices) v = index[v];
    charts[k].push_back(std::move(chart));
  }
  // Islands hold references into themselves.
  state->islands.reserve(static_cast<std::size_t>(n_islands));
  for (int k = 0; k < n_islands; ++k) {
    BinaryUnit unit;
    for (const int v : vertices[k]) {
      for (const double coordinate : positions.row(v)) unit.include(coordinate);
    }
    state->unit.include(unit);
    state->units.push_back(unit);
    const auto position = [&](int v) { return Eigen::Vector3d(unit.scaled(1) * positions.row(v)); };
    Triangles own;
    std::vector<TriangleShape> shapes;
    std::vector<double> own_weights;
    for (const int t : members[k]) {
      const auto& [a, b, c] = triangles[t];
      own.push_back({index[a], index[b], index[c]});
      shapes.push_back(local_isometric_frame(position(a), position(b), position(c)));
      if (!weights.empty()) own_weights.push_back(weights[t]);
    }
    std::vector<char> held;
    for (const int v : vertices[k]) {
      if (!fixed.empty()) held.push_back(fixed[v]);
    }
    if (std::find(held.begin(), held.end(), 1) == held.end()) held.clear();
    poll(own.size());
    state->islands.emplace_back(std::move(vertices[k]), std::move(own), std::move(charts[k]));
    state->islands.back().begin(shapes, own_weights, std::move(held), std::move(equations[k]), options,
                                scope.progress(), state->fixed, state->z);
  }
  return MapRelaxation(std::move(state));
}

MapRelaxation::MapRelaxation(std::unique_ptr<State> state) : state_(std::move(state)) {}
MapRelaxation::~MapRelaxation() = default;
MapRelaxation::MapRelaxation(MapRelaxation&&) noexcept = default;

bool MapRelaxation::advance(int n, const Progress& progress) {
  const CancellationScope scope(progress, "relax");
  const auto goes_on = [&] {
    return std::any_of(state_->islands.begin(), state_->islands.end(), [](const Island& i) { return i.can_advance(); });
  };
  for (int k = 0; k < n && goes_on(); ++k) {
    const Progress within = [&](double, const char* phase) {
      return !progress || scope.progress()(static_cast<double>(k) / n, phase);
    };
    for (Island& island : state_->islands) {
      if (island.can_advance()) island.advance(within, state_->z);
    }
  }
  return goes_on();
}

const ComplexVector& MapRelaxation::z() const { return state_->z; }
const std::vector<char>& MapRelaxation::fixed() const { return state_->fixed; }

double MapRelaxation::energy_before() const {
  return state_->mean([](const Island& island) { return island.energy_before(); });
}

double MapRelaxation::energy() const {
  return state_->mean([](const Island& island) { return island.energy(); });
}

int MapRelaxation::steps() const {
  int steps = 0;
  for (const Island& island : state_->islands) steps = std::max(steps, island.steps());
  return steps;
}

int MapRelaxation::flipped() const {
  int flipped = 0;
  for (const Island& island : state_->islands) flipped += island.flipped();
  return flipped;
}

bool MapRelaxation::has_converged() const {
  return std::all_of(state_->islands.begin(), state_->islands.end(), [](const Island& i) { return i.has_converged(); });
}

}  // namespace spectral_conformal
