#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/progress_function.h"
#include "bindings/turns.h"
#include "mesh/welded_corners.h"
#include "packing/texel_snapping.h"
#include "spectral_conformal/island_packing.h"

namespace spectral_conformal::python {

namespace {

template <class T>
std::vector<T> vector_of(const Array<T>& values) {
  return std::vector<T>(values.data(), values.data() + values.size());
}

PackingOptions packing_options(const Array<double>& regions, double margin, const std::string& turns,
                               const std::string& stacks, bool keeps_stacks, bool keeps_overlaps,
                               double stack_tolerance, double min_size, bool scales, std::uint32_t seed,
                               bool is_quick) {
  PackingOptions options;
  for (py::ssize_t k = 0; k < regions.shape(0); ++k) {
    const double* const r = regions.data() + 4 * k;
    options.regions.push_back({{r[0], r[1]}, {r[2], r[3]}});
  }
  options.margin = margin;
  options.turns = turns == "none"       ? PackingTurns::none
                  : turns == "quarters" ? PackingTurns::quarters
                  : turns == "upright"  ? PackingTurns::upright
                  : turns == "square"   ? PackingTurns::square
                                        : PackingTurns::free;
  options.stacks = stacks == "equal"      ? PackingStacks::equal
                   : stacks == "mirrored" ? PackingStacks::mirrored
                                          : PackingStacks::none;
  options.keeps_stacks = keeps_stacks;
  options.keeps_overlaps = keeps_overlaps;
  options.min_size = min_size;
  options.stack_tolerance = stack_tolerance;
  options.scales = scales;
  options.seed = seed;
  options.is_quick = is_quick;
  return options;
}

/// An IslandPacking that Python threads may share.
class SharedPacking {
 public:
  SharedPacking(const Array<double>& points, const Array<int>& face_offsets, const Array<int>& corners,
                const Array<int>& island_of_face, const Array<int>& region, const Array<bool>& keeps_turn, double unit,
                const Array<double>& regions, double margin, const std::string& turns, const std::string& stacks,
                bool keeps_stacks, bool keeps_overlaps, double stack_tolerance, double min_size, bool scales,
                std::uint32_t seed, bool is_quick, const py::object& progress) {
    PackingIslands islands;
    islands.points = Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(points.data()), points.shape(0));
    islands.face_offsets = vector_of(face_offsets);
    islands.corners = vector_of(corners);
    islands.island_of_face = vector_of(island_of_face);
    islands.region = vector_of(region);
    islands.keeps_turn = vector_of(keeps_turn);
    islands.unit = unit;
    const PackingOptions options = packing_options(regions, margin, turns, stacks, keeps_stacks, keeps_overlaps,
                                                   stack_tolerance, min_size, scales, seed, is_quick);
    const Progress callback = progress_of(progress);
    const py::gil_scoped_release unlocked;
    packing_ = std::make_unique<IslandPacking>(IslandPacking::begin(islands, options, callback));
  }

  bool advance(int n, double seconds, const py::object& progress) {
    const Progress callback = progress_of(progress);
    const Turns::Turn turn(turns_);
    const py::gil_scoped_release unlocked;
    return packing_->advance(n, seconds, callback);
  }

  /// The motions as rows of a 2 by 3 matrix, (n, 2, 3), and the figures.
  py::dict state() {
    const Turns::Turn turn(turns_);
    const IslandPacking& at = *packing_;
    const auto n = static_cast<py::ssize_t>(at.motions().size());
    py::array_t<double> matrices({n, static_cast<py::ssize_t>(2), static_cast<py::ssize_t>(3)});
    double* entry = matrices.mutable_data();
    for (const PlaneMotion& motion : at.motions()) {
      const double sign = motion.mirrors ? -1 : 1;
      const double a = motion.factor.real();
      const double b = motion.factor.imag();
      for (const double value : {a, -b * sign, motion.offset.real(), b, a * sign, motion.offset.imag()}) {
        *entry++ = value;
      }
    }
    return py::dict(py::arg("motions") = matrices, py::arg("has_room") = copy(at.has_room()),
                    py::arg("stack") = copy(at.stack()), py::arg("scale") = at.scale(), py::arg("fill") = at.fill(),
                    py::arg("steps") = at.steps());
  }

 private:
  Turns turns_;
  std::unique_ptr<IslandPacking> packing_;
};

/// The point of each corner (C,), and the first corner of each point (P,), of corners with `vertices` (C,) below
/// n_vertices, `islands` (C,) and `uv` (C, 2).
py::tuple weld_corners(const Array<int>& vertices, const Array<int>& islands, const Array<double>& uv, int n_vertices) {
  WeldedCorners welded;
  {
    const PolledWork polling("packing");
    welded = welded_corners(vertices.data(), islands.data(), reinterpret_cast<const Complex*>(uv.data()),
                            static_cast<int>(vertices.size()), n_vertices);
  }
  return py::make_tuple(copy(welded.point), copy(welded.first_corner));
}

/// The lower and upper corner of each island's bounding box, (n, 4), infinite for none; NaN where a point is.
py::array_t<double> island_bounds(const Array<double>& points, const Array<int>& islands, int n) {
  py::array_t<double> result({static_cast<py::ssize_t>(n), static_cast<py::ssize_t>(4)});
  double* const box = result.mutable_data();
  for (int i = 0; i < n; ++i) std::fill_n(std::fill_n(box + 4 * i, 2, infinity), 2, -infinity);
  for (py::ssize_t p = 0; p < islands.size(); ++p) {
    if (islands.data()[p] < 0) continue;
    double* const own = box + 4 * static_cast<py::ssize_t>(islands.data()[p]);
    for (int axis = 0; axis < 2; ++axis) {
      const double x = points.data()[2 * p + axis];
      // A NaN in the box stays.
      if (!(x >= own[axis]) && own[axis] == own[axis]) own[axis] = x;
      if (!(x <= own[axis + 2]) && own[axis + 2] == own[axis + 2]) own[axis + 2] = x;
    }
  }
  return result;
}

/// The points (V, 2) moved with their islands (V,) by the `motions` (n, 2, 3) of those that move, (n,).
py::array_t<double> moved_with_islands(const Array<double>& points, const Array<int>& islands,
                                       const Array<double>& motions, const Array<bool>& moves) {
  py::array_t<double> result({islands.size(), static_cast<py::ssize_t>(2)});
  double* const to = result.mutable_data();
  std::copy_n(points.data(), points.size(), to);
  for (py::ssize_t p = 0; p < islands.size(); ++p) {
    const int island = islands.data()[p];
    if (island < 0 || !moves.data()[island]) continue;
    const double* const m = motions.data() + 6 * static_cast<py::ssize_t>(island);
    const double u = to[2 * p];
    const double v = to[2 * p + 1];
    to[2 * p] = m[0] * u + m[1] * v + m[2];
    to[2 * p + 1] = m[3] * u + m[4] * v + m[5];
  }
  return result;
}

/// The points (V, 2), in pixels, with the straight borders of their islands (F,) at integers (snap_to_texels).
py::array_t<double> snapped(const Array<double>& points, const Array<int>& face_offsets, const Array<int>& corners,
                            const Array<int>& island_of_face, int n) {
  ComplexVector moved =
      Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(points.data()), points.shape(0));
  {
    const PolledWork polling("packing");
    snap_to_texels(moved, vector_of(face_offsets), vector_of(corners), vector_of(island_of_face), n);
  }
  py::array_t<double> result({points.shape(0), static_cast<py::ssize_t>(2)});
  std::copy_n(reinterpret_cast<const double*>(moved.data()), 2 * moved.size(), result.mutable_data());
  return result;
}

}  // namespace

void bind_island_packing(py::module_& module) {
  module.def("weld_corners", &weld_corners);
  module.def("island_bounds", &island_bounds);
  module.def("moved_with_islands", &moved_with_islands);
  module.def("snapped", &snapped);
  module.attr("MAX_SNAP") = max_snap;
  py::class_<SharedPacking>(module, "Packing", py::module_local())
      .def(py::init<const Array<double>&, const Array<int>&, const Array<int>&, const Array<int>&, const Array<int>&,
                    const Array<bool>&, double, const Array<double>&, double, const std::string&, const std::string&,
                    bool, bool, double, double, bool, std::uint32_t, bool, const py::object&>())
      .def("advance", &SharedPacking::advance)
      .def("state", &SharedPacking::state);
}

}  // namespace spectral_conformal::python
