#include "spectral_conformal/isometric_map.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>

namespace spectral_conformal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2 of an isometry.
constexpr double isometry = 4;
constexpr double virtual_weight = 1e-2;
/// Of a clamped shape, relative to the mean triangle.
constexpr double clamped_weight = 1e-6;
/// A start whose determinant is below this part of the squared norm of its Jacobian (QC above about 2000), or whose
/// scale is below 1e-10 of the mean, counts as without image area: its barrier would dominate everything else.
constexpr double least_determinant = 1e-3;
constexpr double least_squared_scale = 1e-20;

double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }

/// The inner product of the real (2V,) vectors.
double dot(const ComplexVector& a, const ComplexVector& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += a[i].real() * b[i].real() + a[i].imag() * b[i].imag();
  return sum;
}

struct Element {
  std::array<int, 3> corners;
  TriangleShape shape;
  double weight;
  bool measured;  ///< neither virtual nor clamped
  /// 0: the determinant is kept positive. Otherwise it is replaced by (det + sqrt(det^2 + softening^2)) / 2, which is
  /// positive everywhere (Garanzha et al., Foldover-Free Maps in 50 Lines of Code, 2021). Infinite: 1 / s^2 is left
  /// out.
  double softening = 0;

  bool barrier() const { return softening == 0; }
  bool without_area() const { return softening > 0 && std::isfinite(softening); }
};

/// f_z and f_zbar, half the squared norm |f_z|^2 + |f_zbar|^2 and the determinant |f_z|^2 - |f_zbar|^2.
struct Jacobian {
  Complex holomorphic;
  Complex antiholomorphic;
  double half_square;
  double determinant;
  bool has_area() const { return determinant > least_determinant * half_square && determinant > least_squared_scale; }
};

Jacobian jacobian(const Element& element, const ComplexVector& z) {
  const auto& [a, b, c] = element.corners;
  const Complex d1 = z[b] - z[a];
  const Complex d2 = z[c] - z[a];
  const double double_area = element.shape.x1 * element.shape.y2;
  Jacobian j;
  j.holomorphic = element.shape.holomorphic_part(d1, d2) / (2 * double_area);
  j.antiholomorphic = element.shape.antiholomorphic_part(d1, d2) / (2 * double_area);
  j.half_square = std::norm(j.holomorphic) + std::norm(j.antiholomorphic);
  // From the edges, not as a difference of squares: its sign is the one of the image's area.
  j.determinant = cross(d1, d2) / double_area;
  return j;
}

/// The determinant as Element::softening changes it, and the derivative of that.
struct SoftDeterminant {
  double value;
  double slope;
  SoftDeterminant(double determinant, double softening) : value(determinant), slope(1) {
    if (softening == 0) return;
    if (std::isinf(softening)) {
      value = infinity;
      slope = 0;
      return;
    }
    const double root = std::hypot(determinant, softening);
    value = determinant > 0 ? 0.5 * (determinant + root) : 0.5 * softening * softening / (root - determinant);
    slope = value / root;
  }
};

std::vector<Element> make_elements(const std::vector<std::array<int, 3>>& triangles,
                                   const std::vector<TriangleShape>& shapes, const std::vector<double>& coverage,
                                   std::size_t n_virtual) {
  double total = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!shapes[t].clamped) total += coverage[t] * shapes[t].area();
  }
  const double mean = total / static_cast<double>(triangles.size());
  std::vector<Element> elements;
  elements.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const bool is_virtual = t + n_virtual >= triangles.size();
    Element element{triangles[t], shapes[t], coverage[t] * shapes[t].area() / total, !is_virtual && !shapes[t].clamped};
    if (shapes[t].clamped) {
      // The shape says nothing of the map: three weak springs, for vertices that no other triangle holds.
      const double side = std::sqrt(mean);
      element.shape.x1 = side;
      element.shape.x2 = 0.5 * side;
      element.shape.y2 = std::sqrt(0.75) * side;
      element.weight = clamped_weight * mean / total;
      element.softening = infinity;
    }
    if (is_virtual) element.weight *= virtual_weight;
    elements.push_back(element);
  }
  return elements;
}

/// The sum of weight (s1^2 + s2^2 + 1 / s1^2 + 1 / s2^2) = 2 weight (|f_z|^2 + |f_zbar|^2) (1 + 1 / det^2), infinite
/// where a barrier is crossed. The gradient is that of the real (2V,) vector, u + i v.
double energy_and_gradient(const std::vector<Element>& elements, const ComplexVector& z, ComplexVector& gradient) {
  gradient.setZero(z.size());
  double sum = 0;
  for (const Element& element : elements) {
    const Jacobian j = jacobian(element, z);
    if (element.barrier() && !(j.determinant > 0)) return infinity;
    const SoftDeterminant determinant(j.determinant, element.softening);
    const double inverse_square = 1 / (determinant.value * determinant.value);
    sum += 2 * element.weight * j.half_square * (1 + inverse_square);
    const double by_square = 2 * (1 + inverse_square);
    const double by_determinant = -4 * j.half_square * inverse_square / determinant.value * determinant.slope;
    const double scale = element.weight / (element.shape.x1 * element.shape.y2);
    const Complex g = scale * (by_square + by_determinant) * j.holomorphic;
    const Complex h = scale * (by_square - by_determinant) * j.antiholomorphic;
    // With p = x2 + i y2, written out: towards d1, -i p g + i conj(p) h; towards d2, i x1 (g - h).
    const auto& [x1, x2, y2, clamped] = element.shape;
    const Complex towards_b(x2 * (g.imag() - h.imag()) + y2 * (g.real() + h.real()),
                            x2 * (h.real() - g.real()) + y2 * (g.imag() + h.imag()));
    const Complex towards_c(x1 * (h.imag() - g.imag()), x1 * (g.real() - h.real()));
    gradient[element.corners[1]] += towards_b;
    gradient[element.corners[2]] += towards_c;
    gradient[element.corners[0]] -= towards_b + towards_c;
  }
  return sum;
}

/// The smallest positive root of c0 + c1 t + c2 t^2, or infinity.
double smallest_positive_root(double c0, double c1, double c2) {
  const double discriminant = c1 * c1 - 4 * c0 * c2;
  if (!(discriminant >= 0)) return infinity;
  const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
  double smallest = infinity;
  if (q != 0 && c0 / q > 0) smallest = c0 / q;
  if (c2 != 0 && q / c2 > 0) smallest = std::min(smallest, q / c2);
  return smallest;
}

/// The step along `direction` at which the first triangle with image area, however little, loses it.
double largest_step(const std::vector<Element>& elements, const ComplexVector& z, const ComplexVector& direction) {
  double largest = infinity;
  for (const Element& element : elements) {
    const auto& [a, b, c] = element.corners;
    const Complex d1 = z[b] - z[a];
    const Complex d2 = z[c] - z[a];
    if (std::isinf(element.softening) || !(cross(d1, d2) > 0)) continue;
    const Complex change1 = direction[b] - direction[a];
    const Complex change2 = direction[c] - direction[a];
    const double linear = cross(d1, change2) + cross(change1, d2);
    largest = std::min(largest, smallest_positive_root(cross(d1, d2), linear, cross(change1, change2)));
  }
  return largest;
}

int count_flipped(const std::vector<Element>& elements, const ComplexVector& z) {
  return static_cast<int>(std::count_if(elements.begin(), elements.end(), [&](const Element& element) {
    return element.measured && !(jacobian(element, z).determinant > 0);
  }));
}

/// The weight of a triangle's Dirichlet form |f_z|^2 + |f_zbar|^2 in the proxy.
double stiffness(const Element& element, const Jacobian& j) {
  if (std::isinf(element.softening)) return isometry;
  const double larger = std::abs(j.holomorphic) + std::abs(j.antiholomorphic);
  const double smaller = SoftDeterminant(j.determinant, element.softening).value / larger;
  // SLIM's weight is the slope of s^2 + 1 / s^2 over the way from s to 1, halved. Of the two singular values the
  // smaller one has the larger weight, which majorises.
  const double inverse = 1 / smaller;
  const double local_global = 1 + inverse * (1 + inverse * (1 + inverse));
  // It aims at s = 1 in one step, which would crush the surroundings of triangles that are very small in the map, and
  // then be cut short. With this weight such a triangle grows to at most about 1 + 1 / 0.1 times its size at once.
  const double growth = 0.1 * (inverse * inverse) * (inverse * inverse);
  return isometry * std::max(local_global, growth);
}

/// The quadratic form that stands for the energy: a Dirichlet form with one weight per triangle. Real; complex only to
/// use the same factorisation.
class Proxy {
 public:
  Proxy(const std::vector<Element>& elements, Eigen::Index n, FactorizationBackend backend)
      : elements_(elements), factorization_(make_factorization(backend, n)) {
    std::vector<Eigen::Triplet<Complex>> entries;
    entries.reserve(3 * elements.size() + static_cast<std::size_t>(n));
    for (int v = 0; v < n; ++v) entries.emplace_back(v, v, 0.0);
    for (const Element& element : elements) {
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(element.corners[(k + 1) % 3], element.corners[(k + 2) % 3]);
        entries.emplace_back(high, low, 0.0);
      }
    }
    matrix_.resize(n, n);
    matrix_.setFromTriplets(entries.begin(), entries.end());
    for (const Element& element : elements) {
      std::array<int, 3> entry{};
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(element.corners[(k + 1) % 3], element.corners[(k + 2) % 3]);
        entry[k] = entry_of(high, low);
      }
      edge_entries_.push_back(entry);
    }
    factorization_->analyze(matrix_);
  }

  /// Returns false when the form is not positive definite in double precision, however it is levelled. Counts its
  /// attempts.
  bool factorize(const ComplexVector& z, int& attempts) {
    std::vector<double> weights(elements_.size());
    for (std::size_t t = 0; t < elements_.size(); ++t) weights[t] = stiffness(elements_[t], jacobian(elements_[t], z));
    const double largest = *std::max_element(weights.begin(), weights.end());
    for (; least_weight_ < 1; least_weight_ *= 100) {
      assemble(weights, least_weight_ * largest);
      ++attempts;
      if (factorization_->factorize(matrix_)) return true;
    }
    return false;
  }

  void solve(const ComplexVector& b, ComplexVector& x) { factorization_->solve(b, x); }

 private:
  int entry_of(int row, int column) const {
    const int* const rows = matrix_.innerIndexPtr();
    const int* const outer = matrix_.outerIndexPtr();
    return static_cast<int>(std::lower_bound(rows + outer[column], rows + outer[column + 1], row) - rows);
  }

  void assemble(const std::vector<double>& weights, double least) {
    Complex* const value = matrix_.valuePtr();
    const int* const diagonal = matrix_.outerIndexPtr();
    std::fill(value, value + matrix_.nonZeros(), Complex(0));
    for (std::size_t t = 0; t < elements_.size(); ++t) {
      const auto& [x1, x2, y2, clamped] = elements_[t].shape;
      const double double_area = x1 * y2;
      // weight (|f_z|^2 + |f_zbar|^2) is weight / (2 |T|) times the sum of cot |z_i - z_j|^2 / 2 over the edges.
      const double scale = 0.5 * elements_[t].weight * std::max(weights[t], least) / (double_area * double_area);
      const double cotangent[3] = {x1 * x2, x1 * (x1 - x2), x2 * (x2 - x1) + y2 * y2};
      for (int k = 0; k < 3; ++k) {
        const double dirichlet = scale * cotangent[k];
        value[diagonal[elements_[t].corners[(k + 1) % 3]]] += dirichlet;
        value[diagonal[elements_[t].corners[(k + 2) % 3]]] += dirichlet;
        value[edge_entries_[t][k]] -= dirichlet;
      }
    }
    for (Eigen::Index v = 0; v < matrix_.cols(); ++v) {
      if (value[diagonal[v]] == 0.0) value[diagonal[v]] = 1;  // of no triangle: it stays
    }
    // Holds one vertex, which fixes the constant and changes nothing else: gradients have no constant part.
    value[diagonal[elements_.front().corners[0]]] *= 2;
  }

  const std::vector<Element>& elements_;
  std::unique_ptr<Factorization> factorization_;
  HermitianMatrix matrix_;
  std::vector<std::array<int, 3>> edge_entries_;  ///< of the edges opposite to the corners
  /// Weights are raised to this part of the largest one. Over a wider range rounding breaks the factorisation; raising
  /// the small ones keeps the proxy a majoriser and only slows down what needs it least.
  double least_weight_ = 1e-12;
};

/// The two-loop recursion of L-BFGS around the proxy's inverse.
class Directions {
 public:
  void clear() { pairs_.clear(); }

  void add(ComplexVector step, ComplexVector gradient_change) {
    const double curvature = dot(step, gradient_change);
    if (!(curvature > 1e-12 * step.norm() * gradient_change.norm())) return;
    if (pairs_.size() == capacity) pairs_.pop_front();
    pairs_.push_back({std::move(step), std::move(gradient_change), curvature});
  }

  ComplexVector descent(Proxy& proxy, const ComplexVector& gradient) const {
    ComplexVector remaining = gradient;
    std::vector<double> shares(pairs_.size());
    for (std::size_t k = pairs_.size(); k-- > 0;) {
      shares[k] = dot(pairs_[k].step, remaining) / pairs_[k].curvature;
      remaining -= shares[k] * pairs_[k].gradient_change;
    }
    ComplexVector direction;
    proxy.solve(remaining, direction);
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const double share = dot(pairs_[k].gradient_change, direction) / pairs_[k].curvature;
      direction += (shares[k] - share) * pairs_[k].step;
    }
    return -direction;
  }

 private:
  static constexpr std::size_t capacity = 10;
  struct Pair {
    ComplexVector step;
    ComplexVector gradient_change;
    double curvature;
  };
  std::deque<Pair> pairs_;
};

/// The descent on given elements, whose softening it takes away as their images gain area.
class Relaxation {
 public:
  Relaxation(std::vector<Element>& elements, ComplexVector& z, FactorizationBackend backend)
      : elements_(elements), z_(z), proxy_(elements, z.size(), backend) {}

  void run(const IsometryOptions& options, const Progress& progress, IsometricMap& result) {
    soften(1);
    descend_to_rest(options, progress, result);
    if (soft_ == 0) return;
    // The second round presses harder on triangles that the first one did not pull in. It counts only if that helps.
    const ComplexVector first = z_;
    soften(0.5);
    descend_to_rest(options, progress, result);
    if (count_flipped(elements_, z_) >= count_flipped(elements_, first)) z_ = first;
  }

 private:
  static constexpr double quick_fall = 0.6;
  static constexpr double short_step = 0.003;

  struct Step {
    double length = 0;  ///< relative to the full one; 0 when none lowers the energy
    double relative_fall = 0;
  };

  void descend_to_rest(const IsometryOptions& options, const Progress& progress, IsometricMap& result) {
    constexpr int steps_per_factor = 10;
    while (result.factorizations < options.max_factorizations) {
      const double done = static_cast<double>(result.factorizations) / options.max_factorizations;
      directions_.clear();
      if (!proxy_.factorize(z_, result.factorizations)) return;
      for (int k = 0; k < steps_per_factor; ++k) {
        report(progress, done, "relax");
        const Step step = descend();
        if (step.length > 0) ++result.iterations;
        const bool small = step.relative_fall < options.tolerance;
        if (small && k == 0) return;
        // A new factor takes larger steps where the energy changes quickly or barriers cut the steps short.
        if (small || step.relative_fall > quick_fall || step.length < short_step) break;
      }
    }
  }

  Step descend() {
    constexpr double part_of_largest = 0.9;
    constexpr double sufficient = 1e-4;
    constexpr int max_halvings = 20;
    const ComplexVector direction = directions_.descent(proxy_, gradient_);
    const double slope = dot(gradient_, direction);
    if (!(slope < 0)) return {};
    double length = std::min(1.0, part_of_largest * largest_step(elements_, z_, direction));
    for (int k = 0; k < max_halvings; ++k, length *= 0.5) {
      const ComplexVector moved = z_ + length * direction;
      ComplexVector gradient;
      const double energy = energy_and_gradient(elements_, moved, gradient);
      if (!(energy <= energy_ + sufficient * length * slope)) continue;
      // The small constant ends the descent on developable patches, whose energy has no excess.
      const double fall = (energy_ - energy) / (std::abs(energy - isometry) + 1e-4);
      directions_.add(moved - z_, gradient - gradient_);
      z_ = moved;
      energy_ = energy;
      gradient_ = std::move(gradient);
      harden();
      return {length, fall};
    }
    return {};
  }

  /// Softens the triangles without image area, in proportion to their size: as little as their surroundings bear.
  void soften(double share) {
    constexpr double least_softening = 1e-2;
    soft_ = 0;
    for (Element& element : elements_) {
      const Jacobian j = jacobian(element, z_);
      // Once a barrier stands, it is kept.
      if (!element.without_area() && (started_ || !element.barrier() || j.has_area())) continue;
      element.softening = share * std::max(j.half_square, least_softening);
      ++soft_;
    }
    started_ = true;
    energy_ = energy_and_gradient(elements_, z_, gradient_);
  }

  /// Triangles that have gained image area keep it from now on.
  void harden() {
    constexpr double enough = 0.03;
    if (soft_ == 0) return;
    const int before = soft_;
    for (Element& element : elements_) {
      if (!element.without_area()) continue;
      const Jacobian j = jacobian(element, z_);
      if (!(j.has_area() && j.determinant > enough * j.half_square)) continue;
      element.softening = 0;
      --soft_;
    }
    if (soft_ == before) return;
    directions_.clear();
    energy_ = energy_and_gradient(elements_, z_, gradient_);
  }

  std::vector<Element>& elements_;
  ComplexVector& z_;
  Proxy proxy_;
  Directions directions_;
  double energy_ = 0;
  ComplexVector gradient_;
  int soft_ = 0;
  bool started_ = false;  ///< barriers stand
};

/// The factor that gives the measured triangles the mean log scale 0, or 0 when none has image area.
double mean_scale_factor(const std::vector<Element>& elements, const ComplexVector& z) {
  double logarithms = 0;
  double weight = 0;
  for (const Element& element : elements) {
    const Jacobian j = jacobian(element, z);
    if (!element.measured || !(j.determinant > least_determinant * j.half_square)) continue;
    logarithms += element.weight * std::log(j.determinant);
    weight += element.weight;
  }
  return weight > 0 ? std::exp(-0.5 * logarithms / weight) : 0;
}

struct BestScale {
  double factor = 1;
  double energy = 0;
};

/// c^2 P + Q / c^2 is least at c^4 = Q / P.
BestScale best_scale(const std::vector<Element>& elements, const ComplexVector& z) {
  double p = 0;
  double q = 0;
  double weight = 0;
  for (const Element& element : elements) {
    const Jacobian j = jacobian(element, z);
    if (!element.measured || !j.has_area()) continue;
    p += 2 * element.weight * j.half_square;
    q += 2 * element.weight * j.half_square / (j.determinant * j.determinant);
    weight += element.weight;
  }
  if (!(weight > 0)) return {};
  return {std::sqrt(std::sqrt(q / p)), 2 * std::sqrt(p) * std::sqrt(q) / weight};
}

}  // namespace

IsometricMap relax_to_isometry(const std::vector<std::array<int, 3>>& triangles,
                               const std::vector<TriangleShape>& shapes, const std::vector<double>& coverage,
                               std::size_t n_virtual, ComplexVector z, FactorizationBackend backend,
                               const IsometryOptions& options, const Progress& progress) {
  report(progress, 0, "relax");
  std::vector<Element> elements = make_elements(triangles, shapes, coverage, n_virtual);
  IsometricMap result;
  result.z = std::move(z);
  result.flipped = count_flipped(elements, result.z);
  const double factor = mean_scale_factor(elements, result.z);
  if (!(factor > 0) || !std::isfinite(factor)) return result;

  ComplexVector relaxed = factor * result.z;
  result.energy_before = best_scale(elements, relaxed).energy;
  Relaxation(elements, relaxed, backend).run(options, progress, result);
  const BestScale scale = best_scale(elements, relaxed);
  relaxed *= scale.factor;
  const int flipped = count_flipped(elements, relaxed);
  result.energy = result.energy_before;
  if (flipped > result.flipped || !relaxed.allFinite()) return result;
  result.z = std::move(relaxed);
  result.energy = scale.energy;
  result.flipped = flipped;
  return result;
}

}  // namespace spectral_conformal
