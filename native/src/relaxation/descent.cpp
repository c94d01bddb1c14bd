#include "relaxation/descent.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "concurrency/cancellation_scope.h"
#include "geometry/tolerances.h"
#include "relaxation/distortion_sum.h"
#include "relaxation/lbfgs.h"
#include "relaxation/line_search.h"

namespace spectral_conformal {
namespace {

/// The quadratic form that approximates the Hessian of the energy: per triangle one weight each for |f_z|^2 and
/// |f_zbar|^2.
class QuadraticForm {
 public:
  static std::unique_ptr<QuadraticForm> of(const std::vector<DistortionElement>& elements,
                                           const std::vector<char>& fixed, DistortionMeasure measure, Eigen::Index n,
                                           FactorizationBackend backend) {
    std::unique_ptr<QuadraticForm> result(new QuadraticForm(elements, fixed, measure));
    std::vector<Eigen::Triplet<Complex>> entries;
    entries.reserve(3 * elements.size() + static_cast<std::size_t>(n));
    const auto edge = [&](std::size_t t, int k) {
      return std::minmax(elements[t].corners[(k + 1) % 3], elements[t].corners[(k + 2) % 3]);
    };
    for (int v = 0; v < n; ++v) entries.emplace_back(v, v, 0.0);
    for_each_polled(elements.size(), [&](std::size_t t) {
      for (int k = 0; k < 3; ++k) entries.emplace_back(edge(t, k).second, edge(t, k).first, 0.0);
    });
    result->matrix_ = lower_triangle(n, entries);
    for_each_polled(elements.size(), [&](std::size_t t) {
      std::array<int, 3> entry{};
      for (int k = 0; k < 3; ++k) entry[k] = result->entry_of(edge(t, k).second, edge(t, k).first);
      result->edge_entries_.push_back(entry);
    });
    result->factorization_ = make_factorization(backend, n);
    result->factorization_->analyze(result->matrix_);
    return result;
  }

  /// Returns false if the form is not positive definite in double precision, however far its weights are clamped.
  /// Counts its attempts. curvature: per vertex, of other energies.
  /// scale: at which z is measured.
  bool factorize(const ComplexVector& z, double scale, const Eigen::VectorXd& curvature, int& attempts) {
    std::vector<DistortionStiffness> weights;
    weights.reserve(elements_.size());
    double largest = 0;
    for_each_polled(elements_.size(), [&](std::size_t t) {
      const MapJacobian j = jacobian(elements_[t], z).scaled(scale);
      const auto [holomorphic, antiholomorphic] = measure_.stiffness(elements_[t].regularization, j);
      weights.push_back({scale * scale * holomorphic, scale * scale * antiholomorphic});
      largest = std::max(largest, weights.back().antiholomorphic);
    });
    // As for the shift of the conformal energy (reduced_factor.cpp): few attempts, each far above the previous one.
    for (; min_weight_ < 1; min_weight_ *= 100) {
      assemble(weights, curvature, min_weight_ * largest);
      ++attempts;
      if (factorization_->factorize(matrix_)) return true;
    }
    return false;
  }

  void solve(const ComplexVector& b, ComplexVector& x) { factorization_->solve(b, x); }

 private:
  QuadraticForm(const std::vector<DistortionElement>& elements, const std::vector<char>& fixed,
                DistortionMeasure measure)
      : elements_(elements), fixed_(fixed), measure_(measure) {}

  int entry_of(int row, int column) const {
    const int* const rows = matrix_.innerIndexPtr();
    const int* const outer = matrix_.outerIndexPtr();
    return static_cast<int>(std::lower_bound(rows + outer[column], rows + outer[column + 1], row) - rows);
  }

  bool is_fixed(int vertex) const { return !fixed_.empty() && fixed_[vertex]; }

  void assemble(const std::vector<DistortionStiffness>& weights, const Eigen::VectorXd& curvature, double min_weight) {
    Complex* const value = matrix_.valuePtr();
    const int* const diagonal = matrix_.outerIndexPtr();
    std::fill(value, value + matrix_.nonZeros(), Complex(0));
    for_each_polled(elements_.size(), [&](std::size_t t) {
      const auto& [x1, x2, y2, clamped] = elements_[t].shape;
      const double double_area = x1 * y2;
      const double clamping = std::max(weights[t].antiholomorphic, min_weight) / weights[t].antiholomorphic;
      const double antiholomorphic = clamping * weights[t].antiholomorphic;
      const double holomorphic = clamping * weights[t].holomorphic;
      // Half the sum of both weights times |f_z|^2 + |f_zbar|^2, which is 1 / (2 |T|) times the sum of
      // cot |z_i - z_j|^2 / 2 over the edges, and half their difference times the image area over |T|.
      const double mean = 0.5 * (holomorphic + antiholomorphic) * elements_[t].weight;
      const double scale = 0.5 * mean / (double_area * double_area);
      const double area_weight = 0.25 * (antiholomorphic - holomorphic) * elements_[t].weight / double_area;
      const std::array<double, 3> scaled_cotangents = elements_[t].shape.scaled_cotangents();
      for (int k = 0; k < 3; ++k) {
        const int i = elements_[t].corners[(k + 1) % 3];
        const int j = elements_[t].corners[(k + 2) % 3];
        const double dirichlet = scale * scaled_cotangents[k];
        value[diagonal[i]] += dirichlet;
        value[diagonal[j]] += dirichlet;
        if (!is_fixed(i) && !is_fixed(j))
          value[edge_entries_[t][k]] += Complex(-dirichlet, i > j ? area_weight : -area_weight);
      }
    });
    for (int v = 0; v < static_cast<int>(matrix_.cols()); ++v) {
      value[diagonal[v]] += curvature[v];
      // Vertices without a triangle are fixed too.
      if (is_fixed(v) || value[diagonal[v]] == 0.0) value[diagonal[v]] = 1;
    }
    // Hold one vertex. That only fixes the constant, since gradients have no constant part.
    if (fixed_.empty()) value[diagonal[elements_.front().corners[0]]] *= 2;
  }

  const std::vector<DistortionElement>& elements_;
  const std::vector<char>& fixed_;
  DistortionMeasure measure_;
  std::unique_ptr<Factorization> factorization_;
  HermitianMatrix matrix_;
  std::vector<std::array<int, 3>> edge_entries_;  ///< per triangle, of the edges opposite to its corners
  /// Weights are clamped from below to this fraction of the largest. In a wider range rounding would swallow the small
  /// ones and break the factorization. Clamping keeps the form a majorizer and only slows down the triangles with the
  /// least to gain. Raised a hundredfold, permanently, if the factorization still fails.
  double min_weight_ = 1e-12;
};

/// The descent on given elements; triangles that gain image area regain their barriers.
class Relaxation {
 public:
  Relaxation(std::vector<DistortionElement>& elements, const std::vector<char>& fixed, ComplexVector z,
             FactorizationBackend backend, const DescentOptions& options)
      : elements_(elements),
        fixed_(fixed),
        options_(options),
        form_(QuadraticForm::of(elements, fixed, options.measure, z.size(), backend)),
        distortion_(DistortionSum::of(elements, options.measure, z.size())) {
    map_.z = is_sliding() ? options.sliding->coordinates(z) : std::move(z);
    if (is_sliding()) slid_ = std::move(z);
  }

  Descent run(const Progress& progress) {
    // Each round pushes harder on the triangles that the previous one left flipped, as their regularization decreases
    // from their own size toward a barrier. The first suffices on ordinary meshes (12 of 12, relaxed to equal areas).
    constexpr double fractions[] = {1, 0.5, 0.1};
    for (const double fraction : fractions) {
      const bool first = fraction == fractions[0];
      const State before = state();
      const int flipped_before = count_flipped(elements_, z());
      regularize(fraction);
      if (first) result_.energy_before = map_.energy;
      while (!advance(progress)) continue;
      if (!first && count_flipped(elements_, z()) >= flipped_before) restore(before);
      if (is_enough_ || regularized_ == 0 || count_flipped(elements_, z()) == 0) break;
    }
    result_.energy = map_.energy;
    return result_;
  }

  /// Begins the first round.
  void start() {
    regularize(1);
    result_.energy = result_.energy_before = map_.energy;
  }

  /// Takes one step of a round. Returns whether it ended the round; result() then says how.
  bool advance(const Progress& progress) {
    const std::optional<RelaxationStatus> end = step(progress);
    result_.energy = map_.energy;
    if (end) result_.status = *end;
    return end.has_value();
  }

  const Descent& result() const { return result_; }
  const ComplexVector& z() const { return is_sliding() ? slid_ : map_.z; }

 private:
  /// A relative decrease so large that the form is outdated, and a step cut to nearly nothing by barriers: a new factor
  /// costs less than the steps that it saves. With 0.5 or 1.5 times the first, or 0.1 or 10 times the second, the mean
  /// QC differed by at most 3 % on 12 meshes relaxed to equal areas.
  static constexpr double quick_fall = 0.6;
  static constexpr double short_step = 0.003;

  struct Step {
    double length = 0;  ///< relative to the full step; 0 if no step lowers the energy
    double relative_fall = 0;
    double promised_fall = 0;  ///< relative decrease of the quadratic model over the full step
  };

  /// The state that a rejected round must restore.
  struct State {
    ComplexVector x;
    std::vector<double> regularization;
    int regularized = 0;
    double energy = 0;
    RelaxationStatus status = RelaxationStatus::factorization_limit;
  };

  State state() const {
    State state{map_.z, {}, regularized_, map_.energy, result_.status};
    for_each_polled(elements_.size(),
                    [&](std::size_t t) { state.regularization.push_back(elements_[t].regularization); });
    return state;
  }

  void restore(const State& state) {
    map_.z = state.x;
    slide();
    // A barrier raised by the rejected round would be infinite on a triangle that is flipped again.
    for (std::size_t t = 0; t < elements_.size(); ++t) elements_[t].regularization = state.regularization[t];
    distortion_.regularize(elements_);
    regularized_ = state.regularized;
    map_.energy = state.energy;
    result_.status = state.status;
  }

  std::optional<RelaxationStatus> step(const Progress& progress) {
    if (steps_left_ == 0) {
      if (result_.factorizations >= options_.max_factorizations) return RelaxationStatus::factorization_limit;
      done_ = static_cast<double>(result_.factorizations) / options_.max_factorizations;
      lbfgs_.clear();
      if (!form_->factorize(z(), scale_of(z()), curvature(), result_.factorizations))
        return RelaxationStatus::indefinite_form;
      steps_left_ = Lbfgs::capacity;
    }
    report(progress, done_, "relax");
    const bool is_first = steps_left_ == Lbfgs::capacity;
    --steps_left_;
    const Step step = descend();
    if (step.length > 0) ++result_.iterations;
    is_enough_ = options_.is_enough && options_.is_enough(z());
    if (is_enough_) return RelaxationStatus::converged;
    const bool small = step.relative_fall < options_.tolerance;
    if (small && is_first) {
      const bool is_minimum = step.length >= short_step || step.promised_fall < options_.tolerance;
      return is_minimum ? RelaxationStatus::converged : RelaxationStatus::stalled;
    }
    // A new factor allows larger steps if the energy changes quickly or barriers cut the steps short.
    if (small || step.relative_fall > quick_fall || step.length < short_step) steps_left_ = 0;
    return std::nullopt;
  }

  /// The curvature of the boundary barrier.
  Eigen::VectorXd curvature() const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(z().size());
    if (options_.boundary != nullptr) options_.boundary->add_curvature(pairs_, z(), result);
    return result;
  }

  /// The fraction of the step up to which the boundary does not touch itself, with a margin.
  double free_part(const ComplexVector& step) {
    if (options_.boundary == nullptr) return 1;
    auto [part, pairs] = options_.boundary->way_along(z(), step);
    pairs_ = std::move(pairs);
    return part * std::min(1.0, fraction_of_max_step * BoundaryBarrier::max_step(pairs_, z(), part * step));
  }

  /// Whether the energy is that of the map scaled to DescentOptions::area. The area of flipped triangles is a poor
  /// measure of the scale.
  bool has_own_scale() const { return options_.area > 0 && regularized_ == 0; }

  /// At which a map is measured; not finite if it has none.
  double scale_of(const ComplexVector& z) const {
    if (!has_own_scale()) return 1;
    return std::sqrt(options_.area / (options_.area_elsewhere + image_area(elements_, z)));
  }

  double distortion(const ComplexVector& z, ComplexVector& gradient) {
    const double scale = scale_of(z);
    if (!std::isfinite(scale)) {
      gradient = ComplexVector::Zero(z.size());
      return infinity;
    }
    const double energy = distortion_.value_and_gradient(scale * z, gradient);
    if (!has_own_scale() || !std::isfinite(energy)) return energy;
    // The scale falls by half as much as the area grows, relatively.
    const double by_area = -0.5 * scale * real_dot(gradient, z) * scale * scale / options_.area;
    gradient *= scale;
    add_image_area_gradient(elements_, z, by_area, gradient);
    return energy;
  }

  bool is_sliding() const { return options_.sliding != nullptr; }

  /// The map at its coordinates.
  void slide() {
    if (is_sliding()) slid_ = options_.sliding->map_at(map_.z);
  }

  /// x: coordinates of a map, its positions but for what slides. The boundary barrier includes the pairs in pairs_.
  double evaluate(const ComplexVector& x, ComplexVector& gradient) {
    return is_sliding() ? evaluate(x, options_.sliding->map_at(x), gradient) : evaluate(x, x, gradient);
  }

  double evaluate(const ComplexVector& x, const ComplexVector& z, ComplexVector& gradient) {
    double energy = distortion(z, gradient);
    if (options_.boundary != nullptr) energy += options_.boundary->add(pairs_, z, gradient);
    if (is_sliding()) options_.sliding->pull_back(x, gradient);
    for (std::size_t v = 0; v < fixed_.size(); ++v) {
      if (fixed_[v]) gradient[static_cast<Eigen::Index>(v)] = 0;
    }
    if (options_.equations != nullptr) options_.equations->apply(gradient);
    return energy;
  }

  /// The energy above its infimum, attained by an isometry or a similarity.
  double excess(double energy) const {
    // The constant, an invisible distortion of 1e-4, stops the descent on developable charts, which have no excess.
    return std::abs(energy - options_.measure.infimum()) + 1e-4;
  }

  Step descend() {
    const auto inverse = [this](const ComplexVector& b, ComplexVector& x) {
      if (is_sliding()) {
        ComplexVector pushed = b;
        options_.sliding->push_forward(map_.z, pushed);
        form_->solve(pushed, x);
        options_.sliding->pull_back(map_.z, x);
      } else {
        form_->solve(b, x);
      }
      if (options_.equations != nullptr) options_.equations->apply(x);
    };
    const ComplexVector direction = lbfgs_.descent(inverse, map_.gradient);
    const double slope = real_dot(map_.gradient, direction);
    Step step;
    step.promised_fall = -0.5 * slope / excess(map_.energy);
    if (!(slope < 0)) return step;
    const bool is_barred = !options_.may_flip || regularized_ == 0;
    const auto unfolded_part = [&](const ComplexVector& move) {
      return is_barred ? std::min(1.0, fraction_of_max_step * distortion_.max_step(z(), move, infinity)) : 1.0;
    };
    ComplexVector move = direction;
    if (is_sliding()) options_.sliding->push_forward(map_.z, move);
    double length = unfolded_part(move);
    length *= free_part(length * move);
    const double before = map_.energy;
    const auto function = [&](const ComplexVector& x, ComplexVector& gradient) {
      if (!is_sliding()) return evaluate(x, gradient);
      // What slides leaves its tangent: the straight way to where it lies must be free, too.
      constexpr double nearly_all = 0.5 + 0.5 * fraction_of_max_step;
      const ComplexVector slid = options_.sliding->map_at(x);
      const ComplexVector way = slid - z();
      gradient = ComplexVector::Zero(x.size());
      if (!(unfolded_part(way) > nearly_all && free_part(way) > nearly_all)) return infinity;
      return evaluate(x, slid, gradient);
    };
    step.length = move_down(function, direction, slope, length, map_, &lbfgs_);
    if (step.length > 0) {
      slide();
      step.relative_fall = (before - map_.energy) / excess(map_.energy);
      raise_barriers();
    }
    return step;
  }

  /// Regularizes the triangles without image area, in proportion to their size: as little as their surroundings allow.
  void regularize(double fraction) {
    regularized_ = 0;
    for_each_polled(elements_.size(), [&](std::size_t t) {
      DistortionElement& element = elements_[t];
      const MapJacobian j = jacobian(element, z());
      // An existing barrier is kept.
      const bool has_area = options_.keep_all_barriers ? j.determinant > 0 : j.has_area();
      const bool holds = has_area && !options_.may_flip;
      if (!element.without_area() && (started_ || !element.barrier() || holds)) return;
      element.regularization = fraction * own_regularization(j);
      ++regularized_;
    });
    distortion_.regularize(elements_);
    started_ = true;
    steps_left_ = 0;
    if (options_.boundary != nullptr) pairs_ = options_.boundary->pairs_near(z(), ComplexVector::Zero(z().size()));
    map_.energy = evaluate(map_.z, map_.gradient);
  }

  /// Triangles that have gained image area keep it from now on.
  void raise_barriers() {
    // Well above a sliver, so that the new barrier does not dominate the next steps. A third of it
    // changed the mean QC of 12 meshes by 1e-4.
    if (regularized_ == 0) return;
    std::vector<std::size_t> gained;
    for_each_polled(elements_.size(), [&](std::size_t t) {
      if (!elements_[t].without_area()) return;
      const MapJacobian j = jacobian(elements_[t], z());
      if (j.has_area() && j.determinant > 30 * sliver * j.half_square) gained.push_back(t);
    });
    const int left = regularized_ - static_cast<int>(gained.size());
    if (gained.empty() || (options_.may_flip && left > 0)) return;
    for (const std::size_t t : gained) elements_[t].regularization = 0;
    distortion_.regularize(elements_);
    regularized_ = left;
    lbfgs_.clear();
    if (has_own_scale()) steps_left_ = 0;
    map_.energy = evaluate(map_.z, map_.gradient);
  }

  std::vector<DistortionElement>& elements_;
  const std::vector<char>& fixed_;
  DescentOptions options_;
  std::unique_ptr<QuadraticForm> form_;
  DistortionSum distortion_;
  DescendingMap map_;   ///< at its coordinates
  ComplexVector slid_;  ///< the map, if any of it slides
  Lbfgs lbfgs_;
  std::vector<BoundaryBarrier::Pair> pairs_;  ///< for the whole last step
  int regularized_ = 0;                       ///< elements
  std::size_t steps_left_ = 0;                ///< with the present factor
  double done_ = 0;                           ///< fraction of the factorizations before it
  bool started_ = false;                      ///< whether barriers were set
  bool is_enough_ = false;                    ///< DescentOptions::is_enough
  Descent result_;
};

}  // namespace

Descent descend(std::vector<DistortionElement>& elements, const std::vector<char>& fixed, ComplexVector& z,
                FactorizationBackend backend, const DescentOptions& options, const Progress& progress) {
  Relaxation relaxation(elements, fixed, std::move(z), backend, options);
  const Descent result = relaxation.run(progress);
  z = relaxation.z();
  return result;
}

struct StepwiseDescent::State {
  std::vector<DistortionElement> elements;
  std::vector<char> fixed;
  std::optional<Relaxation> relaxation = {};  ///< of these
  bool has_ended = false;
};

StepwiseDescent StepwiseDescent::begin(std::vector<DistortionElement> elements, std::vector<char> fixed,
                                       ComplexVector z, FactorizationBackend backend, const DescentOptions& options) {
  std::unique_ptr<State> state(new State{std::move(elements), std::move(fixed)});
  state->relaxation.emplace(state->elements, state->fixed, std::move(z), backend, options).start();
  return StepwiseDescent(std::move(state));
}

StepwiseDescent::StepwiseDescent(std::unique_ptr<State> state) : state_(std::move(state)) {}
StepwiseDescent::~StepwiseDescent() = default;
StepwiseDescent::StepwiseDescent(StepwiseDescent&&) noexcept = default;

bool StepwiseDescent::advance(const Progress& progress) {
  if (!state_->has_ended) state_->has_ended = state_->relaxation->advance(progress);
  return !state_->has_ended;
}

const ComplexVector& StepwiseDescent::z() const { return state_->relaxation->z(); }
const std::vector<DistortionElement>& StepwiseDescent::elements() const { return state_->elements; }
const Descent& StepwiseDescent::result() const { return state_->relaxation->result(); }

}  // namespace spectral_conformal
