#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

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
#include "spectral_conformal/island_packing.h"

namespace spectral_conformal::python {

namespace {

template <class T>
std::vector<T> vector_of(const Array<T>& values) {
  return std::vector<T>(values.data(), values.data() + values.size());
}

PackingOptions packing_options(const Array<double>& regions, double margin, const std::string& turns,
                               const std::string& stacks, bool keeps_stacks, double stack_tolerance, bool scales,
                               std::uint32_t seed) {
  PackingOptions options;
  for (py::ssize_t k = 0; k < regions.shape(0); ++k) {
    const double* const r = regions.data() + 4 * k;
    options.regions.push_back({{r[0], r[1]}, {r[2], r[3]}});
  }
  options.margin = margin;
  options.turns = turns == "none"       ? PackingTurns::none
                  : turns == "quarters" ? PackingTurns::quarters
                                        : PackingTurns::free;
  options.stacks = stacks == "equal"      ? PackingStacks::equal
                   : stacks == "mirrored" ? PackingStacks::mirrored
                                          : PackingStacks::none;
  options.keeps_stacks = keeps_stacks;
  options.stack_tolerance = stack_tolerance;
  options.scales = scales;
  options.seed = seed;
  return options;
}

/// An IslandPacking that Python threads may share.
class SharedPacking {
 public:
  SharedPacking(const Array<double>& points, const Array<int>& face_offsets, const Array<int>& corners,
                const Array<int>& island_of_face, const Array<int>& region, const Array<bool>& keeps_turn, double unit,
                const Array<double>& regions, double margin, const std::string& turns, const std::string& stacks,
                bool keeps_stacks, double stack_tolerance, bool scales, std::uint32_t seed,
                const py::object& progress) {
    PackingIslands islands;
    islands.points = Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(points.data()), points.shape(0));
    islands.face_offsets = vector_of(face_offsets);
    islands.corners = vector_of(corners);
    islands.island_of_face = vector_of(island_of_face);
    islands.region = vector_of(region);
    islands.keeps_turn = vector_of(keeps_turn);
    islands.unit = unit;
    const PackingOptions options =
        packing_options(regions, margin, turns, stacks, keeps_stacks, stack_tolerance, scales, seed);
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

}  // namespace

void bind_island_packing(py::module_& module) {
  py::class_<SharedPacking>(module, "Packing", py::module_local())
      .def(py::init<const Array<double>&, const Array<int>&, const Array<int>&, const Array<int>&, const Array<int>&,
                    const Array<bool>&, double, const Array<double>&, double, const std::string&, const std::string&,
                    bool, double, bool, std::uint32_t, const py::object&>())
      .def("advance", &SharedPacking::advance)
      .def("state", &SharedPacking::state);
}

}  // namespace spectral_conformal::python
