#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bind.h"
#include "bindings/progress_function.h"
#include "spectral_conformal/margin_fill.h"
#include "spectral_conformal/texture_rebake.h"

namespace spectral_conformal::python {

namespace {

/// Without conversion, as it is drawn onto.
using Coverage = py::array_t<unsigned char, py::array::c_style>;

PixelType pixel_type(const py::array& image) {
  return image.itemsize() == 1 ? PixelType::uint8 : image.itemsize() == 2 ? PixelType::uint16 : PixelType::float32;
}

TextureWrap wrap_of(const std::string& name) {
  return name == "repeat"   ? TextureWrap::repeat
         : name == "mirror" ? TextureWrap::mirror
         : name == "clamp"  ? TextureWrap::clamp
                            : TextureWrap::black;
}

RebakeOptions rebake_options(const std::string& content, bool has_opacity) {
  RebakeOptions options;
  options.content = content == "color"     ? TextureContent::color
                    : content == "normals" ? TextureContent::normals
                                           : TextureContent::data;
  options.has_opacity = has_opacity;
  return options;
}

MapPair map_pair(const Array<double>& new_uv, const Array<int>& triangles) {
  MapPair maps;
  maps.new_uv = new_uv.data();
  maps.triangles = triangles.data();
  maps.n_triangles = static_cast<int>(triangles.shape(0));
  return maps;
}

/// An image (height, width, channels) to draw onto, and its coverage (height, width) of bytes, row by row in memory.
TargetImage target_of(py::array& image, Coverage& coverage) {
  return {{image.mutable_data(), pixel_type(image), static_cast<int>(image.shape(1)), static_cast<int>(image.shape(0)),
           static_cast<int>(image.shape(2))},
          coverage.mutable_data()};
}

/// Which texels have samples, (height, width).
py::array_t<bool> flags_of(const std::vector<unsigned char>& covered, const TargetImage& image) {
  py::array_t<bool> which({image.height, image.width});
  std::copy(covered.begin(), covered.end(), which.mutable_data());
  return which;
}

/// `image`: (h, w, channels) of bytes, 16-bit numbers or single precision, row by row in memory; likewise the target,
/// of as many channels. The frames (C, 3), (C, 4) and (C, 4), for normals only.
py::array_t<bool> rebake(const py::array& image, const Array<double>& old_uv, const Array<double>& new_uv,
                         const Array<int>& triangles, py::array target, Coverage coverage, const std::string& content,
                         bool has_opacity, bool is_nearest, const std::array<std::string, 2>& wrap,
                         std::optional<Array<float>> normals, std::optional<Array<float>> old_tangents,
                         std::optional<Array<float>> new_tangents, const py::object& progress) {
  const ImageView source{image.data(), pixel_type(image), static_cast<int>(image.shape(1)),
                         static_cast<int>(image.shape(0)), static_cast<int>(image.shape(2))};
  RebakeOptions options = rebake_options(content, has_opacity);
  options.is_nearest = is_nearest;
  options.wrap = {wrap_of(wrap[0]), wrap_of(wrap[1])};
  MapPair maps = map_pair(new_uv, triangles);
  maps.old_uv = old_uv.data();
  if (normals && old_tangents && new_tangents) {
    maps.normals = normals->data();
    maps.old_tangents = old_tangents->data();
    maps.new_tangents = new_tangents->data();
  }
  const TargetImage drawn = target_of(target, coverage);
  const Progress callback = progress_of(progress);
  std::vector<unsigned char> covered;
  {
    const py::gil_scoped_release unlocked;
    covered = rebake_texture(source, maps, options, drawn, callback);
  }
  return flags_of(covered, drawn);
}

/// values: (C, channels of the target). Returns the same as `rebake`.
py::array_t<bool> bake_corners(const Array<float>& values, const Array<double>& new_uv, const Array<int>& triangles,
                               py::array target, Coverage coverage, const std::string& content, bool has_opacity,
                               const py::object& progress) {
  const MapPair maps = map_pair(new_uv, triangles);
  const RebakeOptions options = rebake_options(content, has_opacity);
  const TargetImage drawn = target_of(target, coverage);
  const Progress callback = progress_of(progress);
  std::vector<unsigned char> covered;
  {
    const py::gil_scoped_release unlocked;
    covered = bake_corner_values(values.data(), maps, options, drawn, callback);
  }
  return flags_of(covered, drawn);
}

void fill_margin_of(py::array target, Coverage coverage) {
  const TargetImage image = target_of(target, coverage);
  const py::gil_scoped_release unlocked;
  fill_margin(image);
}

}  // namespace

void bind_rebake(py::module_& module) {
  module.attr("MAX_CHANNELS") = max_channels;
  module.attr("MAX_IMAGE_SIDE") = max_image_side;
  module.def("rebake", &rebake);
  module.def("bake_corners", &bake_corners);
  module.def("fill_margin", &fill_margin_of);
}

}  // namespace spectral_conformal::python
