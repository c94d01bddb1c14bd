#include "spectral_conformal/map_relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "concurrency/listening.h"
#include "geometry/signed_area.h"
#include "graph/disjoint_sets.h"
#include "injective/local_unfolding.h"
#include "quality/overlap.h"
#include "relaxation/descent.h"
#include "relaxation/equation_projection.h"

namespace spectral_conformal {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// The boundary of the triangles as closed walks over the edges of an odd number of triangles; every vertex has an even
/// number of these.
std::vector<BoundaryLoop> border_of(const Triangles& triangles) {
  std::vector<std::array<int, 2>> edges;
  edges.reserve(3 * triangles.size());
  for_each_heard(triangles.size(), [&](std::size_t t) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      edges.push_back({low, high});
    }
  });
  std::sort(edges.begin(), edges.end());
  std::vector<std::array<int, 2>> border;
  std::map<int, std::vector<std::size_t>> edges_at;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if ((end - i) % 2 == 1) {
      for (const int v : edges[i]) edges_at[v].push_back(border.size());
      border.push_back(edges[i]);
    }
    i = end;
  }
  std::vector<char> is_walked(border.size(), 0);
  // The next edge to walk from a vertex, or none.
  const auto next_edge = [&](std::vector<std::size_t>& ways) {
    while (!ways.empty() && is_walked[ways.back()]) ways.pop_back();
    return ways.empty() ? border.size() : ways.back();
  };
  std::vector<BoundaryLoop> loops;
  for (auto& [first, ways] : edges_at) {
    while (next_edge(ways) < border.size()) {
      BoundaryLoop loop;
      for (int v = first; loop.empty() || v != first;) {
        loop.push_back(v);
        const std::size_t edge = next_edge(edges_at[v]);
        is_walked[edge] = 1;
        v = border[edge][border[edge][0] == v ? 1 : 0];
      }
      loops.push_back(std::move(loop));
    }
  }
  return loops;
}

int count_overlapping(const Triangles& triangles, const ComplexVector& z) {
  const std::vector<bool> overlapping = overlapping_triangles(triangles, z);
  return static_cast<int>(std::count(overlapping.begin(), overlapping.end(), true));
}

/// One island, in coordinates in which it has its area in 3D and is counterclockwise.
class Island {
 public:
  /// triangles: of the island, on the indices into its `vertices`.
  Island(std::vector<int> vertices, Triangles triangles) : vertices_(std::move(vertices)), all_(std::move(triangles)) {}

  /// shapes and weights: per triangle; fixed: per vertex of the island, or empty; equations: on its vertices; z: the
  /// whole map.
  void begin(const std::vector<TriangleShape>& shapes, const std::vector<double>& weights, std::vector<char> fixed,
             LinearEquations equations, const MapRelaxationOptions& options, const Progress& progress,
             ComplexVector& z) {
    fixed_ = std::move(fixed);
    double whole_area = 0;
    for (std::size_t t = 0; t < all_.size(); ++t) {
      const auto& [a, b, c] = all_[t];
      if (shapes[t].clamped) continue;
      area_ += shapes[t].area();
      whole_area += signed_area(z[vertices_[a]], z[vertices_[b]], z[vertices_[c]]);
    }
    scale_ = std::sqrt(area_ / std::abs(whole_area));
    is_mirrored_ = whole_area < 0;
    is_collapsed_ = area_ > 0 && !(std::isfinite(scale_) && scale_ > 0);
    if (is_collapsed_) scale_ = 1;
    const Complex origin = z[vertices_.front()];
    ComplexVector own(static_cast<Eigen::Index>(vertices_.size()));
    for (Eigen::Index v = 0; v < own.size(); ++v) {
      const Complex from_origin = z[vertices_[v]] - origin;
      own[v] = scale_ * (is_mirrored_ ? std::conj(from_origin) : from_origin);
    }
    if (!(area_ > 0) || is_collapsed_) {
      for (std::size_t t = 0; t < all_.size(); ++t) {
        if (!shapes[t].clamped && !is_positive(all_[t], own, unplaced)) ++flipped_;
      }
      return;
    }

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
    std::vector<BoundaryLoop> border = border_of(all_);
    if (!has_free_vertex(border)) border.clear();
    is_free_ = fixed_.empty() && equations.empty();
    take_part(elements, border, equations);
    own = part_of(map_);
    first_area_ = image_area(elements, own);
    overlapping_ = count_overlapping(all_, map_);
    flipped_ = count_flipped(elements, own, unplaced);
    if (options.fold_free && flipped_ > 0) {
      given_ = own;
      unfold_locally(elements, bound(equations), options.backend, own, progress);
      if (accept(elements, own)) write(own, z);
    }
    energy_before_ = energy_of(elements);
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
    if (!equations.empty()) options_.equations = &projection(std::move(equations), options.backend);
    start(std::move(own));
    // Image areas or coordinates whose squares or inverses double precision cannot hold.
    if (!std::isfinite(energy_before_) || !std::isfinite(descent_->result().energy)) {
      descent_.reset();
      is_collapsed_ = true;
    }
  }

  bool can_advance() const { return descent_ && !has_ended_; }

  /// Takes a step and writes it into the map z, unless the map would have more flipped or overlapping triangles. A few
  /// later steps may still remove these.
  void advance(const Progress& progress, ComplexVector& z) {
    // Of bad starts, triangles overlap on their way around each other.
    constexpr int max_rejected = 50;
    const bool goes_on = descent_->advance(progress);
    if (accept(descent_->elements(), descent_->z())) {
      n_rejected_ = 0;
      const int taken = descent_->result().iterations - std::exchange(steps_of_descent_, descent_->result().iterations);
      steps_ += taken;
      if (taken > 0) write(is_free_ ? at_first_area(descent_->z()) : descent_->z(), z);
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
    has_converged_ = n_rejected_ == 0 && descent_->result().status == DescentStatus::converged;
  }

  double weight() const { return descent_ ? weight_ : 0; }
  double energy_before() const { return energy_before_; }
  double energy() const { return steps_ > 0 ? energy_of(elements_) : energy_before_; }
  int steps() const { return steps_; }
  int flipped() const { return flipped_ + flipped_and_held_; }
  bool is_collapsed() const { return is_collapsed_; }
  bool has_converged() const { return !is_collapsed_ && (!descent_ || has_converged_); }

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

  /// Whether a map has no more flipped and overlapping triangles than the present one, and, while a second descent is
  /// on its way, fewer flipped ones; these numbers are then the present ones.
  bool accept(const std::vector<DistortionElement>& elements, const ComplexVector& own) {
    const int flipped = count_flipped(elements, own, unplaced);
    if (flipped > flipped_) return false;
    if (must_improve_ && flipped == flipped_) return false;
    // Without flips, overlaps and contacts, the barriers keep it so.
    const bool has_defects = overlapping_ > 0 || flipped_ > 0 || flipped_and_held_ > 0;
    const bool is_kept = !has_defects && !(border_ && border_->ignores_contacts());
    const int overlapping = is_kept ? 0 : count_overlapping(all_, with_part(own));
    if (overlapping > overlapping_) return false;
    flipped_ = flipped;
    overlapping_ = overlapping;
    must_improve_ = false;
    return true;
  }

  /// The documented energy of the present map.
  double energy_of(const std::vector<DistortionElement>& elements) const {
    const ComplexVector own = part_of(map_);
    const double scale = std::sqrt(area_ / std::abs(held_area_ + image_area(elements, own)));
    return std::isfinite(scale) ? measured_distortion(elements, measure_, scale * own) : infinity;
  }

  /// A map with the area that the given one has, about the same middle: others beside it keep their density.
  ComplexVector at_first_area(const ComplexVector& own) const {
    const double scale = std::sqrt(first_area_ / image_area(elements_, own));
    if (!(scale > 0) || !std::isfinite(scale)) return own;
    const Complex middle = own.mean();
    return ((own.array() - middle) * scale + middle).matrix();
  }

  /// The fixed vertices and those of equations.
  std::vector<char> bound(const LinearEquations& equations) const {
    std::vector<char> result = fixed_;
    if (!equations.empty()) result.resize(part_.size());
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
    std::vector<char> fixed;
    for (int v = 0; v < static_cast<int>(number.size()); ++v) {
      if (number[v] < 0) continue;
      number[v] = static_cast<int>(part_.size());
      part_.push_back(v);
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

  ComplexVector part_of(const ComplexVector& map) const {
    ComplexVector own(static_cast<Eigen::Index>(part_.size()));
    for (Eigen::Index i = 0; i < own.size(); ++i) own[i] = map[part_[i]];
    return own;
  }

  ComplexVector with_part(const ComplexVector& own) const {
    ComplexVector map = map_;
    for (Eigen::Index i = 0; i < own.size(); ++i) map[part_[i]] = own[i];
    return map;
  }

  /// Adds the displacements of the vertices that moved; the others keep every bit.
  void write(const ComplexVector& own, ComplexVector& z) {
    for (Eigen::Index i = 0; i < own.size(); ++i) {
      const int v = part_[i];
      if (own[i] == map_[v]) continue;
      const Complex displacement = (own[i] - map_[v]) / scale_;
      z[vertices_[v]] += is_mirrored_ ? std::conj(displacement) : displacement;
      map_[v] = own[i];
    }
  }

  std::vector<int> vertices_;
  Triangles all_;
  std::vector<int> part_;    ///< the island's vertices in the descent
  std::vector<char> fixed_;  ///< of these; at first of all vertices
  double scale_ = 0;
  bool is_mirrored_ = false;
  bool is_collapsed_ = false;  ///< without image area that double precision can hold
  bool is_free_ = false;       ///< whether nothing is fixed or constrained
  double area_ = 0;            ///< in 3D
  double held_area_ = 0;       ///< image area of the triangles that cannot move
  double first_area_ = 0;      ///< that of the others, of the given map
  ComplexVector map_;          ///< the present positions of all vertices, in these coordinates
  double weight_ = 0;
  int flipped_ = 0;  ///< of the triangles that move
  int flipped_and_held_ = 0;
  int overlapping_ = 0;
  DistortionMeasure measure_;
  double energy_before_ = 0;
  int steps_ = 0;
  int steps_of_descent_ = 0;   ///< of these, in the present descent
  int n_rejected_ = 0;         ///< steps since the last that was written
  bool must_improve_ = false;  ///< whether a second descent has not yet removed flips
  bool has_ended_ = false;
  bool has_converged_ = false;
  std::vector<DistortionElement> elements_;  ///< those that move, as given to a descent
  ComplexVector given_;                      ///< the start of a second descent, or empty
  FactorizationBackend backend_ = FactorizationBackend::automatic;
  DescentOptions options_;
  std::vector<BoundaryLoop> border_loops_;
  std::optional<BoundaryBarrier> border_;
  std::optional<EquationProjection> equations_;
  std::optional<StepwiseDescent> descent_;
};

}  // namespace

struct MapRelaxation::State {
  ComplexVector z;
  std::vector<Island> islands;

  /// The mean over the islands.
  template <class Energy>
  double mean(const Energy& energy_of) const {
    double sum = 0;
    double weight = 0;
    for (const Island& island : islands) {
      if (!(island.weight() > 0)) continue;
      sum += island.weight() * energy_of(island);
      weight += island.weight();
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
  const Listening listening(progress, "relax");
  state->z = std::move(z);
  const auto n = static_cast<int>(state->z.size());
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
  // Islands hold references into themselves.
  state->islands.reserve(static_cast<std::size_t>(n_islands));
  for (int k = 0; k < n_islands; ++k) {
    Triangles own;
    std::vector<TriangleShape> shapes;
    std::vector<double> own_weights;
    for (const int t : members[k]) {
      const auto& [a, b, c] = triangles[t];
      own.push_back({index[a], index[b], index[c]});
      shapes.push_back(local_isometric_frame(positions.row(a), positions.row(b), positions.row(c)));
      if (!weights.empty()) own_weights.push_back(weights[t]);
    }
    std::vector<char> held;
    for (const int v : vertices[k]) {
      if (!fixed.empty()) held.push_back(fixed[v]);
    }
    if (std::find(held.begin(), held.end(), 1) == held.end()) held.clear();
    still_working(300 * static_cast<double>(own.size()));
    state->islands.emplace_back(std::move(vertices[k]), std::move(own));
    state->islands.back().begin(shapes, own_weights, std::move(held), std::move(equations[k]), options,
                                listening.progress(), state->z);
  }
  return MapRelaxation(std::move(state));
}

MapRelaxation::MapRelaxation(std::unique_ptr<State> state) : state_(std::move(state)) {}
MapRelaxation::~MapRelaxation() = default;
MapRelaxation::MapRelaxation(MapRelaxation&&) noexcept = default;

bool MapRelaxation::advance(int n, const Progress& progress) {
  const Listening listening(progress, "relax");
  const auto goes_on = [&] {
    return std::any_of(state_->islands.begin(), state_->islands.end(), [](const Island& i) { return i.can_advance(); });
  };
  for (int k = 0; k < n && goes_on(); ++k) {
    const Progress within = [&](double, const char* phase) {
      return !progress || listening.progress()(static_cast<double>(k) / n, phase);
    };
    for (Island& island : state_->islands) {
      if (island.can_advance()) island.advance(within, state_->z);
    }
  }
  return goes_on();
}

const ComplexVector& MapRelaxation::z() const { return state_->z; }

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
