#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/progress_function.h"
#include "spectral_conformal/box_packing.h"

namespace spectral_conformal::python {

namespace {

py::tuple pack(const Array<double>& sizes, bool is_quick) {
  const auto n = static_cast<std::size_t>(sizes.shape(0));
  std::vector<PackedBox> boxes(n);
  for (std::size_t i = 0; i < n; ++i) {
    boxes[i].width = sizes.data()[2 * i];
    boxes[i].height = sizes.data()[2 * i + 1];
  }
  double side = 0;
  {
    const PolledWork polling("packing");
    side = pack_boxes(boxes, is_quick ? few_exchanged_boxes : all_exchanged_boxes);
  }
  py::array_t<double> corners({static_cast<py::ssize_t>(n), static_cast<py::ssize_t>(2)});
  double* corner = corners.mutable_data();
  for (const PackedBox& box : boxes) {
    *corner++ = box.x;
    *corner++ = box.y;
  }
  return py::make_tuple(corners, side);
}

}  // namespace

void bind_packing(py::module_& module) { module.def("pack_boxes", &pack); }

}  // namespace spectral_conformal::python
