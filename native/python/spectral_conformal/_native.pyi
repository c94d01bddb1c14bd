"""The compiled part, which the modules beside it call with arguments that they have checked."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from ._arguments import Progress
from ._options import Options, SeamOptions

_Floats = npt.NDArray[np.float64]
_Indices = npt.NDArray[np.int32]
_Flags = npt.NDArray[np.bool_]
_Pins = list[tuple[int, float, float]]
_Extenders = list[tuple[int, int, float, float]]
_Equations = tuple[list[int], list[int], list[float], list[tuple[int, float]]]

CHART_FIELDS: tuple[str, ...]
CHART_NAMES: dict[str, tuple[str | None, ...]]
MAX_CHANNELS: int
MAX_IMAGE_SIDE: int
SIZE_LIMIT: int
VERSION: str

class InvalidMeshError(ValueError): ...
class Cancelled(Exception): ...

class Solver:
    def __init__(
        self,
        vertices: _Floats,
        triangles: _Indices,
        metric: _Floats | None,
        options: Options,
        progress: Progress | None,
    ) -> None: ...
    def factorize(self, progress: Progress | None) -> None: ...
    def solve(
        self,
        options: Options,
        pins: _Pins,
        extenders: _Extenders,
        constraints: _Equations | None,
        progress: Progress | None,
    ) -> dict[str, Any]: ...

class Packing:
    def __init__(
        self,
        points: _Floats,
        face_offsets: _Indices,
        corners: _Indices,
        island_of_face: _Indices,
        region: _Indices,
        keeps_turn: _Flags,
        unit: float,
        regions: _Floats,
        margin: float,
        turns: str,
        stacks: str,
        keeps_stacks: bool,
        keeps_overlaps: bool,
        stack_tolerance: float,
        min_size: float,
        scales: bool,
        seed: int,
        is_quick: bool,
        progress: Progress | None,
    ) -> None: ...
    def advance(self, n: int, seconds: float, progress: Progress | None) -> bool: ...
    def state(self) -> dict[str, Any]: ...

class Relaxation:
    def __init__(
        self,
        vertices: _Floats,
        triangles: _Indices,
        uv: _Floats,
        fixed: _Flags | None,
        weights: _Floats | None,
        constraints: _Equations | None,
        sizes: float,
        tolerance: float,
        border: str,
        fold_free: bool,
        progress: Progress | None,
    ) -> None: ...
    def advance(self, n: int, progress: Progress | None) -> bool: ...
    def state(self) -> dict[str, Any]: ...
    def fixed(self) -> list[bool]: ...

class UnwrapArguments:
    def __init__(
        self,
        vertices: _Floats,
        face_offsets: _Indices,
        corner_vertices: _Indices,
        seam_edges: _Indices | None,
        selected_faces: _Flags | None,
        pins: _Pins,
        pinned_corners: _Flags | None,
        corner_uv: _Floats | None,
        metric: _Floats | None,
        constraints: _Equations | None,
        options: Options,
    ) -> None: ...

class Unwrapper:
    def __init__(self, arguments: UnwrapArguments) -> None: ...
    def solve(
        self,
        options: Options,
        extenders: _Extenders,
        corner_uv: _Floats | None,
        measures: bool,
        progress: Progress | None,
    ) -> dict[str, Any]: ...

class KeptMaps:
    def __init__(self, max_bytes: int) -> None: ...
    def clear(self) -> None: ...
    def size(self) -> int: ...

def unwrap(
    arguments: UnwrapArguments, extenders: _Extenders, progress: Progress | None, kept: KeptMaps | None
) -> dict[str, Any]: ...
def connected_faces(face_offsets: _Indices, corner_vertices: _Indices, n_vertices: int) -> _Indices: ...
def chart_of_face(
    vertices: _Floats,
    face_offsets: _Indices,
    corner_vertices: _Indices,
    seam_edges: _Indices | None,
    selected_faces: _Flags | None,
) -> _Indices: ...
def suggest_seams(
    vertices: _Floats,
    face_offsets: _Indices,
    corner_vertices: _Indices,
    seam_edges: _Indices | None,
    selected_faces: _Flags | None,
    vertex_preference: _Floats | None,
    avoided_edges: _Indices | None,
    preferred_edges: _Indices | None,
    edge_preference: _Floats | None,
    options: SeamOptions,
    progress: Progress | None,
) -> tuple[_Indices, _Indices, int, int]: ...
def energy_at(scale_limit: float, qc_limit: float) -> float: ...
def warn(message: str) -> None: ...
def put_errors_into_words(
    type: type[Exception], words: Callable[[tuple[tuple[Any, ...], ...]], str], memory: str, reentered: str
) -> None: ...
def distortion(vertices: _Floats, triangles: _Indices, uv: _Floats) -> dict[str, Any]: ...
def map_defects(
    face_offsets: _Indices,
    corner_vertices: _Indices,
    corner_uv: _Floats,
    selected_faces: _Flags | None,
    between_islands: bool,
) -> dict[str, Any]: ...
def face_distortion(
    vertices: _Floats,
    face_offsets: _Indices,
    corner_vertices: _Indices,
    corner_uv: npt.NDArray[np.floating],
    selected_faces: _Flags | None,
) -> dict[str, Any]: ...
def face_triangles(
    vertices: _Floats, face_offsets: _Indices, corner_vertices: _Indices, selected_faces: _Flags | None
) -> tuple[_Indices, _Indices]: ...
def metric_from_uv(vertices: _Floats, triangles: _Indices, uv: _Floats) -> _Floats: ...
def metric_from_direction(vertices: _Floats, triangles: _Indices, directions: _Floats, ratios: _Floats) -> _Floats: ...
def blend_metric(metric: _Floats, amount: float) -> _Floats: ...
def first_not_positive_definite(metric: _Floats) -> int: ...
def pack_boxes(sizes: _Floats, is_quick: bool) -> tuple[_Floats, float]: ...
def weld_corners(
    vertices: _Indices, islands: npt.NDArray[np.integer], uv: _Floats, n_vertices: int
) -> tuple[_Indices, _Indices]: ...

MAX_SNAP: float

def island_bounds(points: _Floats, islands: _Indices, n: int) -> _Floats: ...
def snapped(
    points: _Floats, face_offsets: _Indices, corners: _Indices, island_of_face: _Indices, n: int
) -> _Floats: ...
def moved_with_islands(points: _Floats, islands: _Indices, motions: _Floats, moves: _Flags) -> _Floats: ...
def rebake(
    image: np.ndarray,
    old_uv: _Floats,
    new_uv: _Floats,
    triangles: _Indices,
    target: np.ndarray,
    coverage: npt.NDArray[np.uint8],
    content: str,
    has_opacity: bool,
    is_nearest: bool,
    wrap: tuple[str, ...],
    normals: npt.NDArray[np.float32] | None,
    old_tangents: npt.NDArray[np.float32] | None,
    new_tangents: npt.NDArray[np.float32] | None,
    progress: Progress | None,
) -> _Flags: ...
def bake_corners(
    values: npt.NDArray[np.float32],
    new_uv: _Floats,
    triangles: _Indices,
    target: np.ndarray,
    coverage: npt.NDArray[np.uint8],
    content: str,
    has_opacity: bool,
    progress: Progress | None,
) -> _Flags: ...
def fill_margin(target: np.ndarray, coverage: npt.NDArray[np.uint8]) -> None: ...
def rectangle_areas(points: _Floats, offsets: _Indices) -> npt.NDArray[np.float64]: ...
def build_info() -> dict[str, str]: ...
def limit_threads(threads: int) -> int: ...

# For tests and benchmarks.
def counted_work(call: Callable[[], object]) -> dict[str, int]: ...
def exchange_poll_interval(steps: int) -> int: ...
def pretend_cores(cores: int) -> int: ...
