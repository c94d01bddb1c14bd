"""Colors of vertices, drawn to a texture for a new UV map."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import numpy.typing as npt

from ._rebaking import BakedTexture, Target, draw_values_onto
from ._texture_size import TextureSize, map_area

# Of the file and the texture that hold them.
NAME = "vertex_colors"


@dataclass
class VertexColors:
    """The colors of an asset's vertices or corners, for one texture of its whole map.

    Attributes:
        content: color: linear light, which a texture codes by sRGB; data: as they are to be stored.
    """

    content: Literal["data", "color"]
    _values: list[npt.NDArray[np.floating]] = field(default_factory=list)
    _uv: list[npt.NDArray[np.floating]] = field(default_factory=list)
    _triangles: list[npt.NDArray[np.integer]] = field(default_factory=list)
    _rows: int = 0

    def __bool__(self) -> bool:
        """Whether there are any triangles."""
        return bool(self._triangles)

    def add(
        self,
        values: npt.NDArray[np.floating],
        uv: npt.NDArray[np.floating],
        triangles: npt.NDArray[np.integer],
    ) -> None:
        """Add triangles (T, 3), numbers of rows of the colors (n, channels) and of the new map (n, 2), v upward."""
        if not len(triangles):
            return
        used, rows = np.unique(triangles, return_inverse=True)
        self._values.append(np.clip(values[used], 0.0, 1.0))
        self._uv.append(uv[used])
        self._triangles.append(self._rows + rows.reshape(-1, 3))
        self._rows += len(used)

    def drawn(self, size: TextureSize, opacity: bool = False) -> BakedTexture | None:
        """Return the texture, (height, width, 3) bytes, or 4 channels with `opacity`; None without triangles."""
        if not self:
            return None
        width, height = self.wanted(size)
        target = Target((height, width, 4 if opacity else 3), np.uint8)
        return target.baked(self.drawn_onto(target, opacity))

    def wanted(self, size: TextureSize) -> tuple[int, int]:
        """Return the width and height of a texture that keeps the colors."""
        areas = (map_area(uv, triangles - triangles.min()) for uv, triangles in zip(self._uv, self._triangles))
        # By Euler's formula, meshes have about half as many vertices as triangles.
        return size.of_samples(sum(map(len, self._triangles)) // 2, sum(areas))

    def drawn_onto(self, target: Target, opacity: bool = False) -> npt.NDArray[np.bool_]:
        """Draw them onto an image with 3 or 4 channels, as `draw_values_onto` does; they are opaque by default."""
        if not self:
            return np.zeros(target.coverage.shape, bool)
        n_channels = target.image.shape[2]
        filled = [np.c_[each, np.ones((len(each), 1))][:, :n_channels] for each in self._values]
        uv, triangles = np.concatenate(self._uv), np.concatenate(self._triangles)
        return draw_values_onto(target, np.concatenate(filled), uv, triangles, self.content, opacity)
