# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles colored by a value per face or by a UV checker, in the 3D viewport and the UV editor."""

from collections.abc import Sequence
from dataclasses import dataclass

import gpu
import numpy as np

from .. import session
from ..session import Lifetime, Remembered

Color = tuple[float, float, float]

# Drivers guarantee 128 bytes for constants, and Blender uses some. So the last components of the colors are other
# numbers: the value at the lower end, the inverse of the range (negative for hues), and the squares of the checker, 0
# for values.
_CONSTANTS = (
    ("MAT4", "ModelViewProjectionMatrix"),
    ("VEC4", "low"),
    ("VEC4", "middle"),
    ("VEC4", "high"),
    ("FLOAT", "opacity"),
)
_VERTEX = """
void main()
{
  map_position = uv;
  face_value = value;
  gl_Position = ModelViewProjectionMatrix * vec4(PLACE, 1.0);
}
"""
_FRAGMENT = """
vec3 linear(vec3 color)
{
  return mix(color / 12.92, pow((color + 0.055) / 1.055, vec3(2.4)), step(0.04045, color));
}

void main()
{
  vec3 color;
  if (high.w > 0.0) {
    vec2 square = floor(map_position * high.w);
    color = mod(square.x + square.y, 2.0) < 0.5 ? low.xyz : high.xyz;
  }
  else if (middle.w < 0.0) {
    vec3 hue = 0.55 + 0.4 * cos(6.2831853 * (face_value + vec3(0.0, 0.33, 0.67)));
    color = face_value < 0.0 ? low.xyz : hue;
  }
  else {
    float part = clamp((face_value - low.w) * middle.w, 0.0, 1.0);
    color = part < 0.5 ? mix(low.xyz, middle.xyz, 2.0 * part) : mix(middle.xyz, high.xyz, 2.0 * part - 1.0);
  }
  fragment_color = vec4(CONVERT(color), opacity);
}
"""
_POSITIONS = (("position", 3),)
_MAP = (("uv", 2), ("value", 1))


@dataclass(frozen=True)
class Colors:
    """The colors of the lower end, the middle and the upper end of the values, and their opacity, 0 to 1."""

    low: Color
    middle: Color
    high: Color
    opacity: float = 1.0


class _Shaders(Remembered):
    """The compiled shaders, by the arguments of `shader`."""

    lifetime = Lifetime.ADDON

    def __init__(self) -> None:
        self.made: dict[tuple[bool, bool], gpu.types.GPUShader] = {}


def shader(is_flat: bool, is_displayed: bool = True) -> gpu.types.GPUShader:
    """Return the shader that draws the triangles at their positions, or with `is_flat` at their UVs.

    Blender's editors take linear colors. Without `is_displayed` the colors are not converted, for other framebuffers.
    """
    made, key = session.of(_Shaders).made, (is_flat, is_displayed)
    if key not in made:
        made[key] = _compiled(is_flat, is_displayed)
    return made[key]


def _compiled(is_flat: bool, is_displayed: bool) -> gpu.types.GPUShader:
    info = gpu.types.GPUShaderCreateInfo()
    for kind, name in _CONSTANTS:
        info.push_constant(kind, name)
    for index, (name, size) in enumerate(_POSITIONS + _MAP):
        info.vertex_in(index, "FLOAT" if size == 1 else f"VEC{size}", name)
    passed = gpu.types.GPUStageInterfaceInfo("spectral_map_overlay")
    passed.smooth("VEC2", "map_position")
    passed.flat("FLOAT", "face_value")
    info.vertex_out(passed)
    info.fragment_out(0, "VEC4", "fragment_color")
    info.vertex_source(_VERTEX.replace("PLACE", "vec3(uv,0.0)" if is_flat else "position"))
    info.fragment_source(_FRAGMENT.replace("CONVERT", "linear" if is_displayed else ""))
    return gpu.shader.create_from_info(info)


def buffer(positions: np.ndarray) -> gpu.types.GPUVertBuf:
    """Return a buffer of the positions, (3 T, 3) float32, of the corners of triangles, which batches may share."""
    return _buffer(_POSITIONS, positions)


def batch(positions: gpu.types.GPUVertBuf, uv: np.ndarray, values: np.ndarray) -> gpu.types.GPUBatch:
    """Return triangles to draw: their `buffer`, and the UVs (3 T, 2) and values (3 T,) of corners, float32."""
    triangles = gpu.types.GPUBatch(type="TRIS", buf=_buffer(_MAP, uv, values))
    triangles.vertbuf_add(positions)
    return triangles


def _buffer(attributes: Sequence[tuple[str, int]], *arrays: np.ndarray) -> gpu.types.GPUVertBuf:
    vertex_format = gpu.types.GPUVertFormat()
    for name, size in attributes:
        vertex_format.attr_add(id=name, comp_type="F32", len=size, fetch_mode="FLOAT")
    buffer = gpu.types.GPUVertBuf(vertex_format, len(arrays[0]))
    for (name, size), array in zip(attributes, arrays):
        buffer.attr_fill(name, np.ascontiguousarray(array, dtype=np.float32).reshape(-1, size))
    return buffer


def draw(
    triangles: gpu.types.GPUBatch,
    bound: gpu.types.GPUShader,
    colors: Colors,
    low: float,
    high: float,
    checks: float = 0.0,
    as_hues: bool = False,
) -> None:
    """Draw the triangles with the current matrices: their values between `low` and `high`, or a checker.

    With `as_hues` values are hues, 0 to 1; negative ones get the low color.
    """
    bound.bind()
    matrix = gpu.matrix.get_projection_matrix() @ gpu.matrix.get_model_view_matrix()
    bound.uniform_float("ModelViewProjectionMatrix", matrix)
    bound.uniform_float("low", (*colors.low, low))
    bound.uniform_float("middle", (*colors.middle, -1.0 if as_hues else 1.0 / max(high - low, 1e-12)))
    bound.uniform_float("high", (*colors.high, checks))
    bound.uniform_float("opacity", colors.opacity)
    triangles.draw(bound)
