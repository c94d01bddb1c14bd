#include "bindings/options.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

namespace spectral_conformal::python {

namespace {

namespace py = pybind11;

template <class T>
using Name = std::pair<const char*, T>;

constexpr Name<Method> methods[] = {
    {"spectral", Method::spectral}, {"lscm", Method::lscm}, {"fiedler", Method::fiedler}, {"area", Method::area}};
constexpr Name<Weights> weights[] = {{"uniform", Weights::uniform}, {"inverse_area", Weights::inverse_area}};
constexpr Name<BoundaryMeasure> boundaries[] = {{"length", BoundaryMeasure::length},
                                                {"vertex", BoundaryMeasure::vertex}};
constexpr Name<FactorizationBackend> backends[] = {{"auto", FactorizationBackend::automatic},
                                                   {"cholmod", FactorizationBackend::cholmod},
                                                   {"eigen", FactorizationBackend::eigen}};
constexpr Name<Polish> polishes[] = {{"off", Polish::off}, {"angles", Polish::angles}, {"balanced", Polish::balanced}};
constexpr Name<Fallback> fallbacks[] = {{"unfolded", Fallback::unfolded},
                                        {"clamped_triangles", Fallback::clamped_triangles},
                                        {"other_boundary", Fallback::other_boundary},
                                        {"other_weights", Fallback::other_weights},
                                        {"tutte_embedding", Fallback::tutte_embedding}};
constexpr Name<RelaxationStatus> relaxations[] = {{"converged", RelaxationStatus::converged},
                                                  {"factorization_limit", RelaxationStatus::factorization_limit},
                                                  {"stalled", RelaxationStatus::stalled},
                                                  {"indefinite_form", RelaxationStatus::indefinite_form},
                                                  {"no_image_area", RelaxationStatus::no_image_area},
                                                  {"rejected", RelaxationStatus::rejected}};
constexpr Name<EigenvalueOf> eigenvalue_owners[] = {{"eigenvector", EigenvalueOf::eigenvector},
                                                    {"map", EigenvalueOf::map}};

constexpr Name<StepKind> step_kinds[] = {{"rejected", StepKind::rejected},
                                         {"retried", StepKind::retried},
                                         {"winds", StepKind::winds},
                                         {"lowered_rigidity", StepKind::lowered_rigidity},
                                         {"clamped_thin", StepKind::clamped_thin},
                                         {"by_length", StepKind::by_length},
                                         {"by_vertex", StepKind::by_vertex},
                                         {"uniform_weights", StepKind::uniform_weights},
                                         {"inverse_area", StepKind::inverse_area},
                                         {"relaxed_with_flips", StepKind::relaxed_with_flips},
                                         {"blended_little", StepKind::blended_little},
                                         {"embedded", StepKind::embedded},
                                         {"unfolded", StepKind::unfolded},
                                         {"moved_apart", StepKind::moved_apart},
                                         {"moved_apart_embedded", StepKind::moved_apart_embedded},
                                         {"covers_itself", StepKind::covers_itself},
                                         {"still_flipped", StepKind::still_flipped},
                                         {"nearest_to_free", StepKind::nearest_to_free},
                                         {"folds", StepKind::folds},
                                         {"unmet_constraints", StepKind::unmet_constraints},
                                         {"not_injective", StepKind::not_injective},
                                         {"unresolved_triangles", StepKind::unresolved_triangles},
                                         {"reoriented_faces", StepKind::reoriented_faces},
                                         {"duplicate_faces", StepKind::duplicate_faces},
                                         {"fan_splits", StepKind::fan_splits},
                                         {"degenerate_triangles", StepKind::degenerate_triangles},
                                         {"shrunk_to_point", StepKind::shrunk_to_point},
                                         {"degenerate_faces", StepKind::degenerate_faces},
                                         {"out_of_memory", StepKind::out_of_memory}};
constexpr Name<Rejection> rejections[] = {{"not_factorized", Rejection::not_factorized},
                                          {"not_converged", Rejection::not_converged},
                                          {"not_finite", Rejection::not_finite},
                                          {"collapsed", Rejection::collapsed},
                                          {"unresolved", Rejection::unresolved},
                                          {"no_area", Rejection::no_area},
                                          {"winding", Rejection::winding},
                                          {"folded", Rejection::folded},
                                          {"no_embedding", Rejection::no_embedding},
                                          {"too_large", Rejection::too_large},
                                          {"library_failed", Rejection::library_failed},
                                          {"no_cholmod", Rejection::no_cholmod},
                                          {"vertex_not_finite", Rejection::vertex_not_finite},
                                          {"not_orientable", Rejection::not_orientable},
                                          {"closed", Rejection::closed},
                                          {"handles", Rejection::handles},
                                          {"no_extent", Rejection::no_extent},
                                          {"border_of_two", Rejection::border_of_two},
                                          {"no_surface", Rejection::no_surface},
                                          {"degenerate_face", Rejection::degenerate_face},
                                          {"no_faces", Rejection::no_faces},
                                          {"non_manifold_edges", Rejection::non_manifold_edges},
                                          {"several_components", Rejection::several_components},
                                          {"bow_ties", Rejection::bow_ties},
                                          {"too_many_vertices", Rejection::too_many_vertices},
                                          {"too_many_faces", Rejection::too_many_faces},
                                          {"too_many_corners", Rejection::too_many_corners},
                                          {"too_many_seam_edges", Rejection::too_many_seam_edges},
                                          {"offsets_decrease", Rejection::offsets_decrease},
                                          {"offsets_not_from_zero", Rejection::offsets_not_from_zero},
                                          {"corner_of_no_vertex", Rejection::corner_of_no_vertex},
                                          {"seam_of_no_vertex", Rejection::seam_of_no_vertex},
                                          {"not_triangle", Rejection::not_triangle},
                                          {"uv_not_finite", Rejection::uv_not_finite},
                                          {"pinned_uv_not_finite", Rejection::pinned_uv_not_finite},
                                          {"metric_not_positive", Rejection::metric_not_positive},
                                          {"loop_without_length", Rejection::loop_without_length},
                                          {"unused_pinned_vertex", Rejection::unused_pinned_vertex},
                                          {"unused_extender_vertex", Rejection::unused_extender_vertex},
                                          {"pins_at_one_position", Rejection::pins_at_one_position},
                                          {"too_many_pins", Rejection::too_many_pins},
                                          {"method_without_pins", Rejection::method_without_pins},
                                          {"method_without_constraints", Rejection::method_without_constraints},
                                          {"constraints_join_vertices", Rejection::constraints_join_vertices},
                                          {"constraints_flatten_triangle", Rejection::constraints_flatten_triangle},
                                          {"method_without_extenders", Rejection::method_without_extenders}};
/// Which style "auto" means is decided in Python.
constexpr Name<SeamStyle> styles[] = {{"hard", SeamStyle::hard}, {"organic", SeamStyle::organic}};
constexpr Name<Constraint> constraints[] = {{"pins", Constraint::pins},
                                            {"extenders", Constraint::extenders},
                                            {"rigidity", Constraint::rigidity},
                                            {"extenders_and_rigidity", Constraint::extenders_and_rigidity},
                                            {"linear", Constraint::linear}};

/// The value of an option given as a string.
template <class T, std::size_t N>
T named(const py::object& options, const char* option, const Name<T> (&names)[N]) {
  const auto given = options.attr(option).cast<std::string>();
  for (const auto& [name, value] : names) {
    if (given == name) return value;
  }
  throw std::logic_error(std::string(option) + " has the unknown value '" + given + "'");
}

template <class T, std::size_t N>
std::size_t index_of(const Name<T> (&names)[N], T wanted) {
  for (std::size_t i = 0; i < N; ++i) {
    if (names[i].second == wanted) return i;
  }
  throw std::logic_error("a result has a value without a name");
}

template <class T, std::size_t N>
const char* name_in(const Name<T> (&names)[N], T wanted) {
  return names[index_of(names, wanted)].first;
}

template <class T, std::size_t N>
py::tuple all_names(const Name<T> (&names)[N], bool or_none = false) {
  py::list result;
  if (or_none) result.append(py::none());
  for (const auto& [name, value] : names) result.append(name);
  return py::tuple(result);
}

}  // namespace

Pins pins_of(const PinList& list) {
  Pins pins;
  for (const auto& [vertex, u, v] : list) pins[vertex] = Complex(u, v);
  return pins;
}

LinearEquations equations_of(std::optional<EquationArrays>&& arrays) {
  if (!arrays) return {};
  auto& [start, coordinate, coefficient, held] = *arrays;
  return {std::move(start), std::move(coordinate), std::move(coefficient), std::move(held)};
}

std::vector<VertexExtender> extenders_of(const ExtenderList& list) {
  std::vector<VertexExtender> extenders;
  for (const auto& [from, to, strength, half] : list) extenders.push_back({from, to, strength, half});
  return extenders;
}

PatchOptions patch_options_of(const py::object& options) {
  PatchOptions result;
  result.weights = named(options, "weights", weights);
  result.boundary = named(options, "boundary", boundaries);
  result.backend = named(options, "factorization", backends);
  result.fill_holes = options.attr("fill_holes").cast<bool>();
  result.area_blend = options.attr("area_blend").cast<double>();
  return result;
}

SolveOptions solve_options_of(const py::object& options) {
  SolveOptions result;
  result.method = named(options, "method", methods);
  result.tolerance = options.attr("tolerance").cast<double>();
  result.soft_pins = options.attr("soft_pins").cast<double>();
  const py::object rigidity = options.attr("hole_rigidity");
  if (py::isinstance<py::str>(rigidity)) {
    result.hole_rigidity.reset();  // "automatic"
  } else {
    result.hole_rigidity = rigidity.cast<double>();
  }
  result.fallbacks = options.attr("fallbacks").cast<bool>();
  result.fold_free = options.attr("fold_free").cast<bool>();
  result.polish = named(options, "polish", polishes);
  return result;
}

SeamSuggestionOptions seam_options_of(const py::object& options) {
  SeamSuggestionOptions result;
  const py::object max_length = options.attr("max_length");
  result.max_length = max_length.is_none() ? std::numeric_limits<double>::infinity() : max_length.cast<double>();
  result.scale_limit = options.attr("scale_limit").cast<double>();
  result.qc_limit = options.attr("qc_limit").cast<double>();
  result.qc_gain = options.attr("qc_gain").cast<double>();
  result.energy_limit = options.attr("energy_limit").cast<double>();
  const py::object front = options.attr("front");
  if (!front.is_none()) result.front = front.cast<std::array<double, 3>>();
  result.shortest = options.attr("shortest").cast<bool>();
  result.style = named(options, "style", styles);
  result.longest_side = options.attr("longest_side").cast<double>();
  result.map.weights = named(options, "weights", weights);
  result.map.boundary = named(options, "boundary", boundaries);
  result.map.area_blend = options.attr("area_blend").cast<double>();
  result.map.backend = named(options, "factorization", backends);
  return result;
}

py::dict names_of_codes() {
  return py::dict(py::arg("method") = all_names(methods), py::arg("weights") = all_names(weights),
                  py::arg("boundary") = all_names(boundaries), py::arg("eigenvalue_of") = all_names(eigenvalue_owners),
                  py::arg("fallback") = all_names(fallbacks, true),
                  py::arg("relaxation") = all_names(relaxations, true));
}

unsigned char code_of(Method method) { return static_cast<unsigned char>(index_of(methods, method)); }
unsigned char code_of(Weights value) { return static_cast<unsigned char>(index_of(weights, value)); }
unsigned char code_of(BoundaryMeasure boundary) { return static_cast<unsigned char>(index_of(boundaries, boundary)); }
unsigned char code_of(EigenvalueOf eigenvalue_of) {
  return static_cast<unsigned char>(index_of(eigenvalue_owners, eigenvalue_of));
}
unsigned char code_of(Fallback fallback) {
  return fallback == Fallback::none ? 0 : static_cast<unsigned char>(1 + index_of(fallbacks, fallback));
}
unsigned char code_of(std::optional<RelaxationStatus> relaxation) {
  return relaxation ? static_cast<unsigned char>(1 + index_of(relaxations, *relaxation)) : 0;
}

const char* name_of(Method method) { return name_in(methods, method); }
const char* name_of(Weights value) { return name_in(weights, value); }
const char* name_of(BoundaryMeasure boundary) { return name_in(boundaries, boundary); }
const char* name_of(EigenvalueOf eigenvalue_of) { return name_in(eigenvalue_owners, eigenvalue_of); }

py::object name_of(Fallback fallback) {
  if (fallback == Fallback::none) return py::none();
  return py::str(name_in(fallbacks, fallback));
}

py::object name_of(std::optional<RelaxationStatus> relaxation) {
  if (!relaxation) return py::none();
  return py::str(name_in(relaxations, *relaxation));
}

py::tuple steps_of(const std::vector<Step>& steps) {
  py::tuple result(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto& [kind, reason, count, attempts, before, after, constraint, relaxation, index, limit] = steps[i];
    const py::object why =
        reason == Rejection::none ? py::object(py::none()) : py::object(py::str(name_in(rejections, reason)));
    const py::object under =
        constraint == Constraint::none ? py::object(py::none()) : py::object(py::str(name_in(constraints, constraint)));
    result[i] = py::make_tuple(name_in(step_kinds, kind), why, count, attempts, before, after, under,
                               name_of(relaxation), index, limit);
  }
  return result;
}

}  // namespace spectral_conformal::python
