#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/options.h"
#include "bindings/progress_function.h"
#include "bindings/turns.h"
#include "spectral_conformal/map_relaxation.h"

namespace spectral_conformal::python {

namespace {

/// A MapRelaxation that Python threads may share.
class SharedRelaxation {
 public:
  SharedRelaxation(const Array<double>& vertices, const Array<int>& triangles, const Array<double>& uv,
                   const std::optional<Array<bool>>& fixed, const std::optional<Array<double>>& weights,
                   std::optional<EquationArrays> constraints, double sizes, double tolerance, const std::string& border,
                   bool fold_free, const py::object& progress) {
    const Eigen::Map<const Positions> positions(vertices.data(), vertices.shape(0), 3);
    static_assert(sizeof(std::array<int, 3>) == 3 * sizeof(int));
    const auto* const first = reinterpret_cast<const std::array<int, 3>*>(triangles.data());
    const std::vector<std::array<int, 3>> corners(first, first + triangles.shape(0));
    const ComplexVector z = Eigen::Map<const ComplexVector>(reinterpret_cast<const Complex*>(uv.data()), uv.shape(0));
    std::vector<char> held;
    if (fixed) held.assign(fixed->data(), fixed->data() + fixed->size());
    std::vector<double> factors;
    if (weights) factors.assign(weights->data(), weights->data() + weights->size());
    MapRelaxationOptions options;
    options.sizes = sizes;
    options.tolerance = tolerance;
    options.border = border == "sliding" ? Border::sliding : border == "held" ? Border::held : Border::free;
    options.fold_free = fold_free;
    options.constraints = equations_of(std::move(constraints));
    const Progress callback = progress_of(progress);
    const py::gil_scoped_release unlocked;
    relaxation_ =
        std::make_unique<MapRelaxation>(MapRelaxation::begin(positions, corners, z, held, factors, options, callback));
  }

  bool advance(int n, const py::object& progress) {
    const Progress callback = progress_of(progress);
    const Turns::Turn turn(turns_);
    const py::gil_scoped_release unlocked;
    return relaxation_->advance(n, callback);
  }

  py::dict state() {
    const Turns::Turn turn(turns_);
    const MapRelaxation& at = *relaxation_;
    return py::dict(py::arg("uv") = real_view(at.z()), py::arg("energy_before") = at.energy_before(),
                    py::arg("energy") = at.energy(), py::arg("steps") = at.steps(), py::arg("flipped") = at.flipped(),
                    py::arg("converged") = at.has_converged());
  }

  std::vector<bool> fixed() const {
    const std::vector<char>& fixed = relaxation_->fixed();
    return {fixed.begin(), fixed.end()};
  }

 private:
  Turns turns_;
  std::unique_ptr<MapRelaxation> relaxation_;
};

}  // namespace

void bind_relaxation(py::module_& module) {
  py::class_<SharedRelaxation>(module, "Relaxation", py::module_local())
      .def(py::init<const Array<double>&, const Array<int>&, const Array<double>&, const std::optional<Array<bool>>&,
                    const std::optional<Array<double>>&, std::optional<EquationArrays>, double, double,
                    const std::string&, bool, const py::object&>())
      .def("advance", &SharedRelaxation::advance)
      .def("state", &SharedRelaxation::state)
      .def("fixed", &SharedRelaxation::fixed);
}

}  // namespace spectral_conformal::python
