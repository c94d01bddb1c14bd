#include "spectral_conformal/unwrap.h"

#include <algorithm>
#include <array>
#include <map>
#include <new>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "concurrency/listening.h"
#include "concurrency/parallel_calls.h"
#include "conformal/conformal_energy.h"
#include "mesh/chart_checks.h"
#include "mesh/charts.h"
#include "mesh/corner_pins.h"
#include "parameterization/chart_description.h"
#include "parameterization/chart_metric.h"
#include "parameterization/constrained_map.h"
#include "parameterization/stopwatch.h"
#include "quality/overlap.h"
#include "spectral_conformal/distortion.h"
#include "spectral_conformal/kept_maps.h"

namespace spectral_conformal {

namespace {

/// The largest quasi-conformal distortion of a face, defined as in measure_face_distortion: the mean over its
/// triangles, weighted by their area in 3D.
double largest_of_a_face(const Chart& chart, const Distortion& distortion) {
  double largest = 1;
  const std::vector<int>& triangles = distortion.triangulation;
  for (std::size_t k = 0; k < triangles.size();) {
    const int face = chart.triangle_face[static_cast<std::size_t>(triangles[k])];
    double area = 0;
    double qc = 0;
    // The triangles of a face are consecutive.
    for (; k < triangles.size() && chart.triangle_face[static_cast<std::size_t>(triangles[k])] == face; ++k) {
      const int t = triangles[k];
      if (distortion.area[t] == 0) continue;
      area += distortion.area[t];
      qc += distortion.area[t] * distortion.qc[t];
    }
    if (area > 0) largest = std::max(largest, qc / area);
  }
  return largest;
}

/// Sets mean_qc, max_qc, flipped and area of a solved chart.
void measure(const Chart& chart, const ConformalEnergy& energy, const ComplexVector& z, double scale,
             UnwrappedChart& report) {
  const Distortion distortion = measure_distortion(energy.shapes(), chart.triangles, chart.triangle_weights, z);
  report.mean_qc = distortion.mean_qc;
  report.max_qc = largest_of_a_face(chart, distortion);
  int last_flipped = -1;
  for (const int t : distortion.triangulation) {
    const int face = chart.triangle_face[static_cast<std::size_t>(t)];
    if (!distortion.flipped[static_cast<std::size_t>(t)] || face == last_flipped) continue;
    last_flipped = face;
    ++report.flipped;
  }
  report.area = energy.area() * scale * scale;
}

/// Adds the pins of mesh vertices to their copies in a chart, except where corners have pins.
void add_vertex_pins(const PinSplitMesh& split, const Chart& chart, const Pins& vertex_pins, Pins& pins) {
  if (vertex_pins.empty()) return;
  for (int v = 0; v < chart.n_vertices(); ++v) {
    const auto pin = vertex_pins.find(split.original_vertex(chart.vertices[static_cast<std::size_t>(v)]));
    if (pin != vertex_pins.end()) pins.emplace(v, pin->second);
  }
}

/// A mesh cut into charts.
struct Cut {
  PinSplitMesh split;
  PolygonMesh mesh;
  ChartDecomposition decomposition;
  std::vector<int> n_copies;  ///< per given vertex, over all charts
  Cut(const PolygonMesh& given, const CornerPins& corner_pins)
      : split(given, corner_pins),
        mesh(split.view()),
        decomposition(build_charts(mesh)),
        n_copies(static_cast<std::size_t>(given.n_vertices), 0) {
    for (const Chart& chart : decomposition.charts) {
      for (const int v : chart.vertices) ++n_copies[split.original_vertex(v)];
    }
  }
};

/// Finds the extenders of a chart, without testing all extenders for every chart.
class ExtendersOfCharts {
 public:
  /// Both must outlive this object.
  ExtendersOfCharts(const Cut& cut, const std::vector<VertexExtender>& extenders) : cut_(cut), extenders_(extenders) {
    for (std::size_t k = 0; k < extenders.size(); ++k) {
      const auto& [from, to, strength] = extenders[k];
      by_rarer_end_[n_copies(to) < n_copies(from) ? to : from].push_back(k);
    }
  }
  const VertexExtender& operator[](std::size_t k) const { return extenders_[k]; }
  /// The numbers, ascending, of the extenders whose end with fewer copies has one in the chart.
  std::vector<std::size_t> near(const Chart& chart) const {
    std::vector<std::size_t> result;
    if (extenders_.empty()) return result;
    for (const int v : chart.vertices) {
      const auto found = by_rarer_end_.find(cut_.split.original_vertex(v));
      if (found != by_rarer_end_.end()) result.insert(result.end(), found->second.begin(), found->second.end());
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

 private:
  /// 0 if not a vertex of the mesh.
  int n_copies(int vertex) const {
    const bool exists = vertex >= 0 && vertex < static_cast<int>(cut_.n_copies.size());
    return exists ? cut_.n_copies[static_cast<std::size_t>(vertex)] : 0;
  }

  const Cut& cut_;
  const std::vector<VertexExtender>& extenders_;
  std::map<int, std::vector<std::size_t>> by_rarer_end_;
};

/// The equations of each chart, on its vertices.
std::vector<LinearEquations> equations_of_charts(const Cut& cut, const LinearEquations& constraints) {
  std::vector<LinearEquations> result(cut.decomposition.charts.size());
  if (constraints.empty()) return result;
  std::vector<int> chart_of_corner;
  for (int face = 0; face < cut.mesh.n_faces; ++face) {
    const int chart = cut.decomposition.chart_of_face[static_cast<std::size_t>(face)];
    chart_of_corner.resize(static_cast<std::size_t>(cut.mesh.face_offsets[face + 1]), chart);
  }
  std::vector<std::pair<int, double>> terms;
  for (int e = 0; e < constraints.size(); ++e) {
    terms.clear();
    int chart = -1;
    for (int k = constraints.start[e]; k < constraints.start[e + 1]; ++k) {
      const int corner = constraints.coordinate[k] / 2;
      const int of_corner = chart_of_corner[static_cast<std::size_t>(corner)];
      if (of_corner < 0 || (chart >= 0 && of_corner != chart)) {
        chart = -1;
        break;
      }
      chart = of_corner;
      terms.emplace_back(2 * cut.decomposition.chart_vertex_of_corner[corner] + constraints.coordinate[k] % 2,
                         constraints.coefficient[k]);
    }
    if (chart >= 0) result[static_cast<std::size_t>(chart)].add(terms);
  }
  for (const auto& [coordinate, value] : constraints.held) {
    const int chart = chart_of_corner[static_cast<std::size_t>(coordinate / 2)];
    const int vertex = cut.decomposition.chart_vertex_of_corner[coordinate / 2];
    if (chart >= 0) result[static_cast<std::size_t>(chart)].held.emplace_back(2 * vertex + coordinate % 2, value);
  }
  return result;
}

/// Solves one chart, repeatedly; reports failures instead of throwing.
class ChartUnwrapper {
 public:
  /// `cut`, `chart` and `options` must outlive this object.
  ChartUnwrapper(const Cut& cut, const Chart& chart, const UnwrapOptions& options, const LinearEquations& constraints)
      : cut_(cut), chart_(chart), given_(options) {
    report_.n_vertices = chart_.n_vertices();
    report_.method = options.solve.method;
    report_.weights = options.patch.weights;
    report_.boundary = options.patch.boundary;
    report_.faces = chart_.faces;
    report_.faces.insert(report_.faces.end(), chart_.duplicates.begin(), chart_.duplicates.end());
    std::sort(report_.faces.begin(), report_.faces.end());
    try {
      pins_ = pins_at(options.corner_pins.uv);
      report_.n_pins = static_cast<int>(pins_.size());
      options_ = options.solve;
      options_.extenders.clear();
      options_.constraints = constraints;
      options_.hole_rigidity = 0;
      report_.method = method_with_pins(options_, pins_.size());
      is_possible_ = true;
    } catch (const InvalidMesh& problem) {
      report_.steps = {problem.step()};
    }
  }

  /// A map of the chart, if there is one.
  struct Solution {
    UnwrappedChart report;
    ComplexVector z;
    std::vector<std::size_t> acting;  ///< extenders
    Timings timings;
    std::string description;       ///< see describe_chart; empty if nothing is to be kept
    std::optional<Complex> point;  ///< image of a chart without area if other charts have maps
  };

  /// Moves the pinned corners, as in Unwrapper::solve.
  void move_pins(const double* corner_uv) {
    if (!is_possible_ || given_.corner_pins.pinned == nullptr) return;
    try {
      pins_ = pins_at(corner_uv);
      pin_problem_.reset();
    } catch (const InvalidMesh& problem) {
      pin_problem_ = problem.step();
    }
  }

  /// With `kept`, which is only read, takes the map from there if present; this must then be the first solve. Throws
  /// std::bad_alloc after dropping its factor, since other charts need the memory.
  Solution solve(const ExtendersOfCharts& extenders, std::optional<double> hole_rigidity, double tolerance,
                 const Progress& progress, const KeptMaps* kept = nullptr) {
    Solution result{report_, {}, {}, {}, {}, {}};
    if (!is_possible_) return result;
    if (pin_problem_) {
      result.report.steps = {*pin_problem_};
      return result;
    }
    SolveOptions options = options_;
    options.tolerance = tolerance;
    if (report_.method == Method::spectral) {
      options.hole_rigidity = hole_rigidity;
      options.extenders = own(extenders, result.acting);
    }
    try {
      if (!solver_) {
        const Positions positions = chart_.positions(cut_.mesh);
        const std::vector<TriangleMetric> metric = chart_metric(cut_.mesh, chart_, given_.metric);
        if (kept && take(*kept, positions, metric, options, result)) return result;
        solver_ = std::make_unique<Solver>(chart_, positions, given_.patch, metric);
      }
      solve(options, progress, result);
    } catch (const InvalidMesh& problem) {
      result.report.steps = {in_mesh(problem.step())};
      if (has_no_area(chart_, chart_.positions(cut_.mesh))) result.point = mean_of_pins();
    } catch (const SolveFailure& problem) {
      result.report.steps = {problem.step()};
    } catch (const std::bad_alloc&) {
      solver_.reset();
      throw;
    }
    return result;
  }

  /// The result for a chart whose solve ran out of memory.
  Solution out_of_memory() const {
    Solution result{report_, {}, {}, {}, {}, {}};
    result.report.steps = {counted(StepKind::out_of_memory, static_cast<int>(report_.faces.size()))};
    return result;
  }

 private:
  /// The pins of the chart, with the corners' at these positions. Throws InvalidMesh if one is not finite.
  Pins pins_at(const double* corner_uv) const {
    const CornerPins corner_pins{given_.corner_pins.pinned, corner_uv};
    Pins pins = chart_pins(cut_.mesh, chart_, cut_.decomposition.chart_vertex_of_corner, corner_pins);
    add_vertex_pins(cut_.split, chart_, given_.vertex_pins, pins);
    return pins;
  }

  /// A step with the mesh's numbers for vertices.
  Step in_mesh(const Step& step) const {
    std::vector<int> vertices = chart_.vertices;
    for (int& v : vertices) v = cut_.split.original_vertex(v);
    return with_vertices(step, vertices);
  }
  /// The extenders between two different vertices of the chart; appends their numbers to `acting`.
  std::vector<Extender> own(const ExtendersOfCharts& extenders, std::vector<std::size_t>& acting) {
    std::vector<Extender> result;
    for (const std::size_t k : extenders.near(chart_)) {
      const VertexExtender& extender = extenders[k];
      std::vector<int> from = copies(extender.from);
      std::vector<int> to = copies(extender.to);
      if (extender.from == extender.to || from.empty() || to.empty()) continue;
      result.push_back({std::move(from), std::move(to), extender.strength});
      acting.push_back(k);
    }
    return result;
  }

  /// The chart vertices that are copies of a mesh vertex.
  std::vector<int> copies(int vertex) {
    if (by_mesh_vertex_.empty()) {
      by_mesh_vertex_.reserve(chart_.vertices.size());
      for (int v = 0; v < chart_.n_vertices(); ++v) {
        by_mesh_vertex_.push_back({cut_.split.original_vertex(chart_.vertices[static_cast<std::size_t>(v)]), v});
      }
      std::sort(by_mesh_vertex_.begin(), by_mesh_vertex_.end());
    }
    std::vector<int> result;
    for (auto it = std::lower_bound(by_mesh_vertex_.begin(), by_mesh_vertex_.end(), std::pair<int, int>(vertex, 0));
         it != by_mesh_vertex_.end() && it->first == vertex; ++it) {
      result.push_back(it->second);
    }
    return result;
  }

  /// Takes the map of a chart from the kept ones; false if there is none.
  bool take(const KeptMaps& kept, const Positions& positions, const std::vector<TriangleMetric>& metric,
            const SolveOptions& options, Solution& result) const {
    Stopwatch watch(result.timings);
    result.description = describe_chart(chart_, positions, metric, given_.patch, options, pins_);
    const KeptMaps::Map* map = kept.find(result.description);
    if (map) {
      result.report = map->report;
      result.report.reused = true;
      result.z = map->z;
    }
    watch.lap("kept maps");
    return map != nullptr;
  }

  void solve(const SolveOptions& options, const Progress& progress, Solution& result) {
    UnwrappedChart& report = result.report;
    Parameterization solution = solver_->solve(options, pins_, progress);
    static_cast<SolveRecord&>(report) = solution;
    add_seconds(solution.timings, result.timings);
    Stopwatch watch(result.timings);
    measure(chart_, solver_->energy(), solution.z, solver_->scale(), report);
    report.overlapping = static_cast<int>(overlapping_faces(chart_, solution.z).size());
    watch.lap("quality");
    report.solved = true;
    result.z = std::move(solution.z);
  }

  Complex mean_of_pins() const {
    Complex sum = 0;
    for (const auto& [vertex, pin] : pins_) sum += pin;
    return sum / static_cast<double>(std::max<std::size_t>(pins_.size(), 1));
  }

  const Cut& cut_;
  const Chart& chart_;
  const UnwrapOptions& given_;
  UnwrappedChart report_;  ///< the report before a solve
  Pins pins_;
  std::optional<Step> pin_problem_;                  ///< why the pins have no valid positions, if they have none
  SolveOptions options_;                             ///< without forces
  bool is_possible_ = false;                         ///< false: the report says why
  std::unique_ptr<Solver> solver_;                   ///< made by the first solve
  std::vector<std::pair<int, int>> by_mesh_vertex_;  ///< (mesh vertex, chart vertex), sorted; made on demand
};

/// Writes the UVs of the corners of some faces, each from its chart vertex.
template <class Map>
void write_corners(const Cut& cut, const std::vector<int>& faces, const Map& map, Unwrap& result) {
  for_each_heard(faces.size(), [&](std::size_t i) {
    const int face = faces[i];
    for (int c = cut.mesh.face_offsets[face]; c < cut.mesh.face_offsets[face + 1]; ++c) {
      const Complex uv = map(cut.decomposition.chart_vertex_of_corner[c]);
      result.uv.row(c) << uv.real(), uv.imag();
      result.solved_corners[c] = true;
    }
  });
}

/// Charts without area, by their number in the result, each with the point that it becomes.
using Points = std::vector<std::pair<std::size_t, Complex>>;

/// Adds a chart to the result: writes the UVs of its corners and marks its acting extenders as used. Stores its map in
/// `kept`, which may be null, if memory allows.
void add(const Cut& cut, ChartUnwrapper::Solution&& solution, Unwrap& result, Points& points,
         KeptMaps* kept = nullptr) {
  add_seconds(solution.timings, result.timings);
  if (solution.report.solved) {
    for (const std::size_t k : solution.acting) result.unused_extenders[k] = false;
    write_corners(
        cut, solution.report.faces, [&](int vertex) { return solution.z[vertex]; }, result);
  }
  if (solution.point) points.push_back({result.charts.size(), *solution.point});
  // The result of a chart without area depends on the other charts.
  if (kept && !solution.point && !solution.description.empty()) {
    try {
      UnwrappedChart report = solution.report;
      report.reused = false;
      kept->keep(std::move(solution.description), {std::move(report), std::move(solution.z)});
    } catch (const std::bad_alloc&) {
      // It will be solved again.
    }
  }
  result.charts.push_back(std::move(solution.report));
}

/// If another chart has a map, charts without area become points, which cover nothing; otherwise nothing is mapped.
void add_points(const Cut& cut, const Points& points, Unwrap& result) {
  const bool has_map = std::any_of(result.charts.begin(), result.charts.end(), [](const auto& c) { return c.solved; });
  if (!has_map) return;
  for (const auto& [i, point] : points) {
    UnwrappedChart& report = result.charts[i];
    report.solved = true;
    // L z = 0 for constant z.
    report.eigenvalue = report.residual = 0;
    report.mean_qc = report.max_qc = 1;
    report.steps = {{StepKind::shrunk_to_point}};
    write_corners(
        cut, report.faces, [place = point](int) { return place; }, result);
  }
}

/// A result still without charts.
Unwrap empty_result(const Cut& cut, std::size_t n_extenders) {
  const int n_corners = cut.mesh.n_faces == 0 ? 0 : cut.mesh.face_offsets[cut.mesh.n_faces];
  Unwrap result;
  result.uv.setZero(n_corners, 2);
  result.solved_corners.assign(static_cast<std::size_t>(n_corners), false);
  result.chart_of_face = cut.decomposition.chart_of_face;
  result.unused_extenders.assign(n_extenders, true);
  result.charts.reserve(cut.decomposition.charts.size() + 1);
  return result;
}

void add_degenerate_faces(const Cut& cut, Unwrap& result) {
  const std::vector<int>& faces = cut.decomposition.degenerate_faces;
  if (faces.empty()) return;
  for (const int face : faces) result.chart_of_face[face] = static_cast<int>(result.charts.size());
  UnwrappedChart unusable;
  unusable.faces = faces;
  unusable.steps = {{StepKind::degenerate_faces}};
  result.charts.push_back(std::move(unusable));
}

/// Iterates over all charts: small ones in parallel, large ones one after another.
class ChartLoop {
 public:
  explicit ChartLoop(const std::vector<Chart>& charts) {
    constexpr double cutting = 0.05;  // share of making the charts in the work, which is counted by faces
    double total = 1e-9;              // avoids a division by zero without charts
    for (const Chart& chart : charts) total += static_cast<double>(chart.faces.size());
    double done = 0;
    end_.push_back(cutting);
    for (const Chart& chart : charts) {
      n_faces_.push_back(chart.faces.size());
      done += static_cast<double>(chart.faces.size());
      end_.push_back(cutting + (1 - cutting) * done / total);
    }
  }

  /// Calls solve(i, progress), and then write(its solution) in the order of the charts. A chart that runs out of memory
  /// beside others is solved again alone; if that fails too, give_up(i) replaces its solve. Throws std::bad_alloc if
  /// every chart fails so.
  template <class Solve, class GiveUp, class Write>
  void run(const Progress& progress, const Solve& solve, const GiveUp& give_up, const Write& write) const {
    int first = 0;
    int given_up = 0;
    while (first < size()) {
      const int last = end_of_batch(first);
      std::vector<std::optional<ChartUnwrapper::Solution>> solutions(static_cast<std::size_t>(last - first));
      run_in_parallel(
          last - first,
          [&](int k, const Progress& charts_progress) {
            const int i = first + k;
            try {
              solutions[static_cast<std::size_t>(k)] = solve(i, part(charts_progress, end_[i], end_[i + 1]));
            } catch (const std::bad_alloc&) {
              // It stays without a solution.
            }
          },
          progress, "eigenproblem", max_threads_for(face_nanoseconds * static_cast<double>(n_faces_of(first, last))));
      const bool were_others = last - first > 1;
      // Progress must not fall.
      const Progress rest = [&](double, const char* phase) { return !progress || progress(end_[last], phase); };
      for (std::optional<ChartUnwrapper::Solution>& solution : solutions) {
        if (!solution && were_others) solution = solved_alone(first, rest, solve);
        if (!solution) {
          solution = give_up(first);
          ++given_up;
        }
        // This frees its memory.
        write(*std::exchange(solution, std::nullopt));
        ++first;
      }
    }
    if (given_up > 0 && given_up == size()) throw std::bad_alloc();
  }

 private:
  /// Larger charts parallelize their own factorization, and take too much memory for two at a time.
  static constexpr std::size_t max_faces_together = 20000;
  /// Per batch: the maps of all its charts are kept until it ends.
  static constexpr std::size_t max_faces_in_batch = 400000;
  /// Likewise: even a chart of one face takes a kilobyte until then.
  static constexpr int max_charts_in_batch = 20000;
  /// Approximate minimum time per face.
  static constexpr double face_nanoseconds = 1000;

  template <class Solve>
  static std::optional<ChartUnwrapper::Solution> solved_alone(int i, const Progress& progress, const Solve& solve) {
    try {
      return solve(i, progress);
    } catch (const std::bad_alloc&) {
      return std::nullopt;
    }
  }
  int size() const { return static_cast<int>(n_faces_.size()); }
  std::size_t n_faces_of(int first, int last) const {
    return std::accumulate(n_faces_.begin() + first, n_faces_.begin() + last, std::size_t{0});
  }
  int end_of_batch(int first) const {
    std::size_t n_faces = n_faces_[first];
    int last = first + 1;
    if (n_faces > max_faces_together) return last;
    const int end = std::min(size(), first + max_charts_in_batch);
    while (last < end && n_faces_[last] <= max_faces_together && n_faces + n_faces_[last] <= max_faces_in_batch) {
      n_faces += n_faces_[last++];
    }
    return last;
  }

  std::vector<std::size_t> n_faces_;  ///< of each chart
  std::vector<double> end_;           ///< fraction of the work before each chart, and after the last
};

}  // namespace

Unwrap unwrap(const PolygonMesh& mesh, const UnwrapOptions& options, const Progress& given, KeptMaps* kept) {
  const Listening listening(given, "charts");
  const Progress& progress = listening.progress();
  report(progress, 0.0, "charts");
  Timings timings;
  Stopwatch watch(timings);
  Cut cut(mesh, options.corner_pins);
  watch.lap("charts");
  Unwrap result = empty_result(cut, options.extenders.size());
  result.timings.swap(timings);
  std::vector<Chart>& charts = cut.decomposition.charts;
  const ChartLoop loop(charts);
  const ExtendersOfCharts extenders(cut, options.extenders);
  const std::vector<LinearEquations> constraints = equations_of_charts(cut, options.constraints);
  Points points;
  loop.run(
      progress,
      [&](int i, const Progress& charts_progress) {
        Chart& chart = charts[static_cast<std::size_t>(i)];
        ChartUnwrapper::Solution solution =
            ChartUnwrapper(cut, chart, options, constraints[static_cast<std::size_t>(i)])
                .solve(extenders, options.solve.hole_rigidity, options.solve.tolerance, charts_progress, kept);
        // Each frees its memory before the next solve.
        const Chart solved = std::move(chart);
        return solution;
      },
      [&](int i) { return ChartUnwrapper(cut, charts[static_cast<std::size_t>(i)], options, {}).out_of_memory(); },
      [&](ChartUnwrapper::Solution&& solution) { add(cut, std::move(solution), result, points, kept); });
  add_points(cut, points, result);
  add_degenerate_faces(cut, result);
  return result;
}

struct Unwrapper::State {
  Cut cut;
  ChartLoop loop;
  std::vector<ChartUnwrapper> charts;
  const double* corner_uv;  ///< as given first
  State(const PolygonMesh& mesh, const UnwrapOptions& options)
      : cut(mesh, options.corner_pins), loop(cut.decomposition.charts), corner_uv(options.corner_pins.uv) {
    charts.reserve(cut.decomposition.charts.size());
    const std::vector<LinearEquations> constraints = equations_of_charts(cut, options.constraints);
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      charts.emplace_back(cut, cut.decomposition.charts[i], options, constraints[i]);
    }
  }
};

Unwrapper::Unwrapper(const PolygonMesh& mesh, const UnwrapOptions& options)
    : state_(std::make_unique<State>(mesh, options)) {}

Unwrapper::~Unwrapper() = default;

Unwrap Unwrapper::solve(const std::vector<VertexExtender>& extenders, std::optional<double> hole_rigidity,
                        double tolerance, const double* corner_uv, const Progress& given) {
  const Listening listening(given, "ordering");
  const Progress& progress = listening.progress();
  Unwrap result = empty_result(state_->cut, extenders.size());
  const ExtendersOfCharts extenders_of_charts(state_->cut, extenders);
  const double* pinned_at = corner_uv != nullptr ? corner_uv : state_->corner_uv;
  Points points;
  state_->loop.run(
      progress,
      [&](int i, const Progress& charts_progress) {
        ChartUnwrapper& chart = state_->charts[static_cast<std::size_t>(i)];
        chart.move_pins(pinned_at);
        return chart.solve(extenders_of_charts, hole_rigidity, tolerance, charts_progress);
      },
      [&](int i) { return state_->charts[static_cast<std::size_t>(i)].out_of_memory(); },
      [&](ChartUnwrapper::Solution&& solution) { add(state_->cut, std::move(solution), result, points); });
  add_points(state_->cut, points, result);
  add_degenerate_faces(state_->cut, result);
  return result;
}

}  // namespace spectral_conformal
