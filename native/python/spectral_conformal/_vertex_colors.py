"""Colors of vertices, drawn to a texture for a new UV map."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import numpy.typing as npt

from ._rebaking import BakedTexture, bake_values
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

    def add(
        self,
        values: npt.NDArray[np.floating],
        uv: npt.NDArray[np.floating],
        triangles: npt.NDArray[np.integer],
    ) -> None:
        """Add triangles (T, 3), numbers of rows of the colors (n, channels) and of the new map (n, 2), v upward."""
        used, rows = np.unique(triangles, return_inverse=True)
        self._values.append(np.clip(values[used], 0.0, 1.0))
        self._uv.append(uv[used])
        self._triangles.append(self._rows + rows.reshape(-1, 3))
        self._rows += len(used)

    def drawn(self, size: TextureSize, opacity: bool = False) -> BakedTexture | None:
        """Return the texture, (height, width, 3) bytes, or 4 channels with `opacity`; None without triangles."""
        n_triangles = sum(map(len, self._triangles))
        if not n_triangles:
            return None
        n_channels = 4 if opacity else 3
        filled = [np.c_[each, np.ones((len(each), 1))][:, :n_channels] for each in self._values]
        uv, triangles = np.concatenate(self._uv), np.concatenate(self._triangles)
        # By Euler's formula, meshes have about half as many vertices as triangles.
        chosen = size.of_samples(n_triangles // 2, map_area(uv, triangles))
        return bake_values(np.concatenate(filled), uv, triangles, size=chosen, content=self.content, opacity=opacity)
