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
#include "spectral_conformal/texture_rebake.h"

namespace spectral_conformal::python {

namespace {

PixelType pixel_type(const py::array& image) {
  return image.itemsize() == 1 ? PixelType::uint8 : image.itemsize() == 2 ? PixelType::uint16 : PixelType::float32;
}

TextureWrap wrap_of(const std::string& name) {
  return name == "repeat" ? TextureWrap::repeat : name == "mirror" ? TextureWrap::mirror : TextureWrap::clamp;
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

/// An image (height, width, channels) of zeros.
struct NewImage {
  NewImage(const py::dtype& type, int width, int height, py::ssize_t n_channels)
      : array(type, {static_cast<py::ssize_t>(height), static_cast<py::ssize_t>(width), n_channels}) {
    auto* const bytes = static_cast<unsigned char*>(array.mutable_data());
    std::fill_n(bytes, array.nbytes(), static_cast<unsigned char>(0));
    target = {bytes, pixel_type(array), width, height, static_cast<int>(n_channels)};
  }
  py::tuple with(const std::vector<unsigned char>& covered) const {
    py::array_t<bool> which({array.shape(0), array.shape(1)});
    std::copy(covered.begin(), covered.end(), which.mutable_data());
    return py::make_tuple(array, which);
  }

  py::array array;
  TargetImage target;
};

/// `image`: (h, w, channels) of bytes, 16-bit numbers or single precision, row by row in memory; likewise the result,
/// with which of its texels have samples, (height, width). The frames (C, 3), (C, 4) and (C, 4), for normals only.
py::tuple rebake(const py::array& image, const Array<double>& old_uv, const Array<double>& new_uv,
                 const Array<int>& triangles, int width, int height, const std::string& content, bool has_opacity,
                 bool is_nearest, const std::array<std::string, 2>& wrap, std::optional<Array<float>> normals,
                 std::optional<Array<float>> old_tangents, std::optional<Array<float>> new_tangents,
                 const py::object& progress) {
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
  const NewImage made(image.dtype(), width, height, image.shape(2));
  const Progress callback = progress_of(progress);
  std::vector<unsigned char> covered;
  {
    const py::gil_scoped_release unlocked;
    covered = rebake_texture(source, maps, options, made.target, callback);
  }
  return made.with(covered);
}

/// values: (C, channels). Returns the same as `rebake`, in the given type.
py::tuple bake_corners(const Array<float>& values, const Array<double>& new_uv, const Array<int>& triangles, int width,
                       int height, const py::dtype& type, const std::string& content, bool has_opacity,
                       const py::object& progress) {
  const MapPair maps = map_pair(new_uv, triangles);
  const RebakeOptions options = rebake_options(content, has_opacity);
  const NewImage made(type, width, height, values.shape(1));
  const Progress callback = progress_of(progress);
  std::vector<unsigned char> covered;
  {
    const py::gil_scoped_release unlocked;
    covered = bake_corner_values(values.data(), maps, options, made.target, callback);
  }
  return made.with(covered);
}

}  // namespace

void bind_rebake(py::module_& module) {
  module.attr("MAX_CHANNELS") = max_channels;
  module.attr("MAX_IMAGE_SIDE") = max_image_side;
  module.def("rebake", &rebake);
  module.def("bake_corners", &bake_corners);
}

}  // namespace spectral_conformal::python
