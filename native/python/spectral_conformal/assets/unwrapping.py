"""From the meshes of an asset to its UV map: cut them into islands, unwrap these and lay them out."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .. import _layout, _measuring, defaults
from .._island_packing import PackedMap, Rotation
from .._mesh import Mesh, uv_per_length
from .._options import Options, SeamOptions
from .._results import Unwrap
from .._seam_style import style_of
from .._seams import suggest_cuts, suggest_seams
from .._unwrapping import unwrap
from . import degenerate, welding
from .mesh import AssetMesh, UvMap, offsets_of
from .welding import Integers

SEAMS = ("keep", "suggest", "sharp", "merge")
MOST_TILES = 100
# What gets a texture of its own.
SHEETS = ("asset", "object", "material")


@dataclass(frozen=True)
class Cutting:
    """Where to cut meshes.

    Attributes:
        seams: "keep": at the edges that the file marks as seams or, if it marks none, at the island borders of its map.
            "suggest": at marked edges, and where that lowers the distortion most, along borders of materials where that
            serves as well. "sharp": at marked edges, and where the surface bends by `sharp_angle` or more. "merge": at
            marked edges, and at those island borders of the map without which distortion would exceed its limits.
        sharp_angle: in degrees, between the normals of two faces.
        weld_distance: vertices on open borders closer than this fraction of the bounding box's diagonal count as one; 0
            for none. With "keep", the vertices of a file without a map stay separate, because nothing else says where
            its islands end.
        between_materials: whether islands end where the material changes.
        options: of the search for seams.
    """

    seams: str = "keep"
    sharp_angle: float = 30.0
    weld_distance: float = welding.DISTANCES[0]
    between_materials: bool = False
    options: SeamOptions = defaults.SEAMS


@dataclass(frozen=True)
class CutMesh:
    """A mesh and its cuts."""

    mesh: AssetMesh
    vertex_of: Integers
    """(V,) the vertex that represents each vertex."""
    seam_edges: Integers
    """(S, 2) edges of the welded mesh."""
    message: str = ""
    """For people: the parts for which no seams were found; empty if there are none."""

    @property
    def polygons(self) -> tuple[npt.NDArray[np.float64], Integers, Integers]:
        """The welded mesh, whose faces have each vertex once in a row."""
        kept = self.kept_corners
        counts = np.add.reduceat(kept.astype(np.int64), self.mesh.face_offsets[:-1])
        return self.mesh.vertices, offsets_of(counts), self.welded_corners[kept]

    @property
    def welded_corners(self) -> Integers:
        """(C,) the vertices of all corners."""
        return self.vertex_of[self.mesh.corner_vertices]

    @property
    def kept_corners(self) -> npt.NDArray[np.bool_]:
        """(C,) the corners of `polygons`."""
        return degenerate.single_corners(self.mesh.face_offsets, self.welded_corners)

    @property
    def seam_length(self) -> float:
        """Length of the seams in the mesh's unit; coincident edges count once."""
        ends = self.mesh.vertices[np.unique(np.sort(self.seam_edges, axis=1), axis=0)]
        return float(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum())

    @property
    def style(self) -> Literal["hard", "organic"]:
        """The style of seams that suits the shape."""
        mesh = self.mesh
        return style_of(mesh.vertices, mesh.face_offsets, mesh.corner_vertices, vertex_of=self.vertex_of)


@dataclass(frozen=True)
class Layout:
    """How to lay out islands.

    Attributes:
        pack: shape: pack all islands by their shapes; box: by their bounding boxes, upright; none: each goes to its
            former position, and only those without one are packed, as boxes.
        margin: in pixels, between islands, and between them and the border of the texture.
        width: of the texture, in pixels.
        height: of the texture, in pixels.
        density: pixels per unit of length in the scene for packed islands; 0 for as many as the texture has room for.
        tiles: UDIM tiles to fill, from 1001 on; "auto" for as many as the density needs. Only with "shape", like the
            next four.
        rotation: as in `pack`.
        min_size: as in `pack`, in pixels.
        snap: as in `pack`.
        keep_overlaps: as in `pack`, of existing islands.
        pack_by: what has a texture of its own, and is packed on its own: the whole "asset", each "object", or each
            "material".
    """

    pack: str = "shape"
    margin: float = defaults.MARGIN
    width: int = defaults.TEXTURE_SIZE
    height: int = defaults.TEXTURE_SIZE
    density: float = 0.0
    tiles: int | Literal["auto"] = 1
    rotation: Rotation = defaults.ROTATION
    min_size: float = 0.0
    snap: bool = False
    keep_overlaps: bool = False
    pack_by: str = "asset"


def cut(mesh: AssetMesh, cutting: Cutting) -> CutMesh:
    """Find the cuts of a mesh; the borders of its parts are among them.

    Raises:
        ValueError: the search for seams rejects the mesh; the message says why.
    """
    keeps_map = cutting.seams == "keep" and not len(mesh.seam_edges)
    vertex_of = np.arange(len(mesh.vertices))
    if cutting.weld_distance and (cutting.seams != "keep" or mesh.corner_uv is not None):
        vertex_of = welding.coincident_vertices(
            mesh.vertices, mesh.face_offsets, mesh.corner_vertices, cutting.weld_distance
        )
    found = CutMesh(mesh, vertex_of, vertex_of[mesh.seam_edges])
    # Objects that touch are one mesh in some files; islands end with them.
    seams = [found.seam_edges, welding.borders_between(mesh, vertex_of, mesh.part_of_face)]
    if keeps_map and mesh.corner_uv is not None:
        seams.append(_layout.map_seams(mesh.face_offsets, vertex_of[mesh.corner_vertices], mesh.corner_uv))
    if cutting.between_materials:
        seams.append(welding.borders_between(mesh, vertex_of, mesh.material_of_face))
    message = ""
    is_merged = cutting.seams == "merge" and mesh.has_uv().any()
    if cutting.seams == "sharp":
        seams.append(welding.sharp_edges(mesh, vertex_of, math.radians(cutting.sharp_angle)))
    elif is_merged:
        borders = _layout.map_seams(mesh.face_offsets, vertex_of[mesh.corner_vertices], mesh.corner_uv)
        merged = suggest_seams(
            *found.polygons, seam_edges=np.concatenate(seams), start_edges=borders, options=cutting.options
        )
        seams = [merged.seam_edges]
    elif cutting.seams in ("suggest", "merge"):
        cuts = suggest_cuts(
            *found.polygons,
            seam_edges=np.concatenate(seams),
            preferred_edges=welding.borders_between(mesh, vertex_of, mesh.material_of_face),
            options=cutting.options,
        )
        seams += cuts
        message = cuts.message
        if cutting.seams == "merge":
            message = f"seams were suggested, since there is no UV map with islands to merge. {message}".rstrip()
    return CutMesh(mesh, vertex_of, np.concatenate(seams).astype(np.int64), message)


def unwrapped(cut_mesh: CutMesh, options: Options, straighten: Literal["auto"] | float = 0.0) -> Unwrap:
    """Unwrap a cut mesh; pins from its file stay fixed, and faces without area lie inside the islands of others.

    `options` and `straighten` are those of `unwrap`.

    Raises:
        ValueError: the mesh cannot be unwrapped; the message says why.
    """
    mesh = cut_mesh.mesh
    pins = mesh.pinned_corners
    if pins is not None and mesh.corner_uv is not None:
        pins = pins & np.isfinite(mesh.corner_uv).all(axis=1)
    polygons, kept = cut_mesh.polygons, cut_mesh.kept_corners
    is_held = pins is not None and pins[kept].any()
    held: dict[str, Any] = {"fixed": pins[kept]} if is_held else {}
    given = Mesh(*polygons[:2], mesh.corner_uv[kept] if is_held else None, corner_vertices=polygons[2])
    left_out = degenerate.repeats_a_vertex(*polygons[1:])
    if left_out.any() and not left_out.all():
        held["selected_faces"] = ~left_out
    result = unwrap(given, seam_edges=cut_mesh.seam_edges, options=options, straighten=straighten, **held)
    result = degenerate.settled(polygons, result, left_out & (result.chart_of_face < 0))
    return degenerate.with_repeats(result, mesh.face_offsets, cut_mesh.welded_corners)


def on_sizes(results: Sequence[Unwrap | None]) -> list[str]:
    """Return the warning about islands whose sizes vary visibly, such as a ring made of an open tube, or nothing."""
    deviations = [result.charts.column("scale_deviation") for result in results if result is not None]
    uneven = _measuring.uneven(np.concatenate([np.zeros(0), *deviations]))
    if not len(uneven):
        return []
    islands = "1 island varies" if len(uneven) == 1 else f"{len(uneven)} islands vary"
    return [
        f"{islands} in size by up to {100.0 * (2.0 ** uneven.max() - 1.0):.0f} %; seams that open what is closed "
        "(--seams suggest) or --area-blend even sizes out."
    ]


def laid_out(meshes: Sequence[AssetMesh], results: Sequence[Unwrap | None], layout: Layout) -> list[UvMap]:
    """Lay out the islands of all meshes of an asset in one texture, at one scale relative to the scene.

    Islands that could not be unwrapped, and meshes without a result, keep their UVs from the file. Islands with two or
    more pins stay at their pins.

    Raises:
        ValueError: the margin leaves no room for this many islands, or the texture none for the layout's density.
    """
    new, packed, found = [], [], []
    for mesh, result in zip(meshes, results):
        n_corners = len(mesh.corner_vertices)
        if result is None:
            new.append(np.full(n_corners, -1))
            packed.append(np.full(n_corners, -1))
            found.append(np.zeros((n_corners, 2)))
            continue
        solved = result.charts.column("status") == "solved"
        is_held = result.charts.column("n_pins") > 1
        new.append(_of_corner(mesh, result, solved))
        packed.append(_of_corner(mesh, result, solved & ~is_held))
        scale = np.where(packed[-1] < 0, 1.0, mesh.scale * _density_factors(mesh, packed[-1]))
        found.append(scale[:, None] * result.uv)
    former = _former(meshes)
    uv, chart, is_kept = np.concatenate(found), _numbered_together(packed), np.concatenate(new) < 0
    if layout.pack == "shape":
        # A former map may fill the tile, and islands that keep it are no obstacles; those held by pins are.
        uv[is_kept] = np.nan

    size, aspect = np.array([layout.width, layout.height]), layout.width / layout.height
    per_length = layout.density / size if layout.density else [aspect**-0.5, aspect**0.5]
    # UVs of charts held by pins are those of the texture.
    in_texture = np.where((chart >= 0)[:, None], uv * per_length, uv)

    def pack(corners: Integers, offsets: Integers) -> npt.NDArray[np.float64]:
        if layout.pack == "shape":
            return _packed_by_shape(in_texture[corners], offsets, chart[corners], layout)
        return _placed(uv[corners], former[corners], chart[corners], layout)

    uv = _by_sheet(pack, meshes, layout.pack_by)
    return _maps(meshes, np.where(is_kept[:, None], former, uv))


def sheets_of(meshes: Sequence[AssetMesh], pack_by: str) -> list[Integers]:
    """Return the number of the texture of every face, (faces,) for each mesh; see `Layout.pack_by`."""
    result, first = [], 0
    for mesh in meshes:
        n_faces = len(mesh.face_offsets) - 1
        if pack_by == "material":
            result.append(mesh.materials())
        elif pack_by == "object":
            part = np.zeros(n_faces, np.int64) if mesh.part_of_face is None else mesh.part_of_face + 1
            result.append(first + part)
            first += len(mesh.parts) + 1
        else:
            result.append(np.zeros(n_faces, np.int64))
    return result


def _by_sheet(
    pack: Callable[[Integers, Integers], npt.NDArray[np.float64]], meshes: Sequence[AssetMesh], pack_by: str
) -> npt.NDArray[np.float64]:
    """Return what `pack` returns for the corners and the offsets of the faces of each texture, (C, 2)."""
    sheet = np.concatenate(sheets_of(meshes, pack_by))
    sizes = np.concatenate([np.diff(mesh.face_offsets) for mesh in meshes])
    faces = np.argsort(sheet, kind="stable")
    corners = np.argsort(np.repeat(sheet, sizes), kind="stable")
    result = np.empty((len(corners), 2))
    at = 0
    for own in np.split(faces, np.flatnonzero(np.diff(sheet[faces])) + 1):
        offsets = offsets_of(sizes[own])
        chosen = corners[at : at + offsets[-1]]
        result[chosen] = pack(chosen, offsets)
        at += offsets[-1]
    return result


def share_of_boxes(meshes: Sequence[AssetMesh], results: Sequence[Unwrap | None], maps: Sequence[UvMap]) -> float:
    """Return the area of the new islands over that of their bounding boxes in the map; 1 without any area."""
    covered, boxes = 0.0, 0.0
    for mesh, result, uv_map in zip(meshes, results, maps):
        if result is None:
            continue
        chart = _of_corner(mesh, result, result.charts.column("status") == "solved")
        order = np.argsort(chart, kind="stable")[int((chart < 0).sum()) :]
        if len(order):
            firsts = np.append(0, np.flatnonzero(np.diff(chart[order])) + 1)
            low, high = (find.reduceat(uv_map.uv[order], firsts) for find in (np.minimum, np.maximum))
            boxes += float(np.prod(high - low, axis=1).sum())
            flat = np.column_stack([uv_map.uv, np.zeros(len(chart))])
            area = degenerate.areas(flat, mesh.face_offsets, np.arange(len(chart))) / 2
            covered += float(area[chart[mesh.face_offsets[:-1]] >= 0].sum())
    return covered / boxes if boxes else 1.0


def _density_factors(mesh: AssetMesh, chart: Integers) -> npt.NDArray[np.float64]:
    """Return the factor of each corner's chart, (C,), the average over its area; `chart` (C,), -1 for none."""
    if mesh.density_factors is None:
        return np.ones(len(chart))
    first = mesh.face_offsets[:-1]
    area = degenerate.areas(mesh.vertices, mesh.face_offsets, mesh.corner_vertices)
    with np.errstate(over="ignore", invalid="ignore"):
        total = np.bincount(chart[first] + 1, area)[1:]
        wanted = np.bincount(chart[first] + 1, area * mesh.density_factors)[1:]
    mean = np.divide(wanted, total, out=np.ones_like(total), where=(total > 0.0) & np.isfinite(wanted))
    # The last entry is that of no chart.
    return np.append(mean, 1.0)[chart]


def laid_out_anew(meshes: Sequence[AssetMesh], islands: Sequence[Integers], layout: Layout) -> list[UvMap]:
    """Lay out the existing islands of meshes, whose sizes keep their ratios.

    With a density, that is the average of the map. Without one, islands keep their sizes if the number of tiles is
    open, and otherwise fill the texture.

    Args:
        meshes: of an asset.
        islands: for each mesh (faces,), -1 for faces without an island.
        layout: how to lay them out.

    Raises:
        ValueError: the margin leaves no room for this many islands, or the texture none for the layout's density.
    """
    uv = _former(meshes)
    if layout.pack == "none":
        return _maps(meshes, uv)
    chart = [np.where(mesh.has_uv(), island, -1)[mesh.face_of_corner()] for mesh, island in zip(meshes, islands)]
    # The map belongs to the texture, whatever its aspect.
    numbered, size = _numbered_together(chart), np.array([layout.width, layout.height])
    if layout.density:
        uv *= layout.density / _density(meshes, uv * size, numbered)

    def pack(corners: Integers, offsets: Integers) -> npt.NDArray[np.float64]:
        if layout.pack == "shape":
            kept = {"keep_stacks": True, "keep_overlaps": layout.keep_overlaps}
            return _packed_by_shape(uv[corners], offsets, numbered[corners], layout, **kept)
        if layout.density:
            return _at_density(uv[corners] * size / layout.density, numbered[corners], layout)
        return _layout.packed(uv[corners], numbered[corners], _margin(layout))

    return _maps(meshes, _by_sheet(pack, meshes, layout.pack_by))


def _density(meshes: Sequence[AssetMesh], pixels: npt.NDArray[np.float64], chart: Integers) -> float:
    """Return the pixels per unit of length in the scene of the corners' charts, whose map is `pixels`, (C, 2).

    Raises:
        ValueError: they have no area, in the map or the scene.
    """
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    corners = np.concatenate([start + mesh.corner_vertices for start, mesh in zip(first, meshes)])
    offsets = offsets_of(np.concatenate([np.diff(mesh.face_offsets) for mesh in meshes]))
    vertices = np.concatenate([mesh.scale * mesh.vertices for mesh in meshes])
    pixels = np.where((chart >= 0)[:, None], pixels, 0.0)
    found = uv_per_length(Mesh(vertices, offsets, pixels, corner_vertices=corners), chart[offsets[:-1]] >= 0)
    if not found > 0.0:
        raise ValueError("a density needs a map with area; leave out texel_density.")
    return found


def _options_of(layout: Layout) -> dict[str, Any]:
    """Return the options of `pack`."""
    return {
        "margin": layout.margin,
        "texture_size": (layout.width, layout.height),
        "tiles": range(1001, 1001 + (MOST_TILES if layout.tiles == "auto" else layout.tiles)),
        "fewest": layout.tiles == "auto",
        "rotation": layout.rotation,
        "min_size": layout.min_size,
        "snap": layout.snap,
    }


def _placed(
    uv: npt.NDArray[np.float64], former: npt.NDArray[np.float64], chart: Integers, layout: Layout
) -> npt.NDArray[np.float64]:
    aspect = layout.width / layout.height
    if layout.pack == "none":
        isotropy = np.array([aspect**0.5, aspect**-0.5])
        there, placed = _layout.onto_former(uv, former * isotropy, chart)
        uv = np.where(placed[:, None], there / isotropy, uv)
        chart = np.where(placed, -1, chart)
    if layout.density:
        return _at_density(uv, chart, layout)
    return _layout.packed(uv, chart, _margin(layout), aspect)


def _at_density(uv: npt.NDArray[np.float64], chart: Integers, layout: Layout) -> npt.NDArray[np.float64]:
    """Pack charts, whose `uv` are lengths in the scene, so that a unit of length has `layout.density` pixels.

    The packed layout, which fills the texture, shrinks by r = wanted / found density toward the corner of the texture.
    So charts are packed with the margin m / r; that lowers the found density, and the margin r' (m / r) is at least m.
    """
    margin = layout.margin
    for _ in range(2):
        result = _layout.packed(
            uv, chart, (margin / layout.width, margin / layout.height), layout.width / layout.height
        )
        found = _layout.scale_between(uv, result * [layout.width, layout.height], chart)
        shrink = layout.density / found
        if shrink > 1.0:
            raise ValueError(
                f"a density of {layout.density:g} pixels per unit needs about {shrink:.3g} times the texture size "
                f"{layout.width}x{layout.height}; the texture has room for {found:.3g}."
            )
        margin = layout.margin / shrink
    return np.where((chart >= 0)[:, None], result * shrink, result)


def _packed_by_shape(
    uv: npt.NDArray[np.float64], offsets: Integers, chart: Integers, layout: Layout, **kept: bool
) -> npt.NDArray[np.float64]:
    """Pack charts, whose `uv` are those of the texture, into the layout's tiles.

    They keep their sizes if the layout has a density or an open number of tiles. `kept` are options of `pack`.
    """
    keeps_size = layout.density > 0.0 or layout.tiles == "auto"

    def pack(scale: bool) -> PackedMap:
        return _layout.packed_by_shape(uv, offsets, chart, scale=scale, **kept, **_options_of(layout))

    try:
        packing = pack(scale=not keeps_size)
    except ValueError as error:
        if not layout.density or layout.tiles != "auto":
            raise
        raise ValueError(f"a density of {layout.density:g} pixels per unit is too high: {error}") from error
    if keeps_size and not packing.has_room.all():
        fitting = pack(scale=True).scale
        raise ValueError(
            f"a density of {layout.density:g} pixels per unit needs about {1.0 / fitting:.3g} times the texture size "
            f"{layout.width}x{layout.height}; the texture has room for {fitting * layout.density:.3g}."
        )
    return packing.uv


def _margin(layout: Layout) -> tuple[float, float]:
    return layout.margin / layout.width, layout.margin / layout.height


def _of_corner(mesh: AssetMesh, result: Unwrap, counted: npt.NDArray[np.bool_]) -> Integers:
    """Return the chart of every corner (C,), -1 for charts that are not counted."""
    chart = np.where(np.append(counted, False)[result.chart_of_face], result.chart_of_face, -1)
    return chart[mesh.face_of_corner()]


def _numbered_together(charts: Sequence[Integers]) -> Integers:
    first, numbered = 0, []
    for chart in charts:
        numbered.append(np.where(chart >= 0, first + chart, -1))
        first += int(chart.max(initial=-1)) + 1
    return np.concatenate(numbered)


def _former(meshes: Sequence[AssetMesh]) -> npt.NDArray[np.float64]:
    """Return the current UVs of all corners, (C, 2), NaN for corners without one."""
    return np.concatenate(
        [np.full((len(m.corner_vertices), 2), np.nan) if m.corner_uv is None else m.corner_uv for m in meshes]
    )


def _maps(meshes: Sequence[AssetMesh], uv: npt.NDArray[np.float64]) -> list[UvMap]:
    parts = np.split(uv, np.cumsum([len(mesh.corner_vertices) for mesh in meshes])[:-1])
    maps = []
    for mesh, part in zip(meshes, parts):
        mapped = np.logical_and.reduceat(np.isfinite(part).all(axis=1), mesh.face_offsets[:-1])
        part = np.where(np.repeat(mapped, np.diff(mesh.face_offsets))[:, None], part, 0.0)
        maps.append(UvMap(part, mapped))
    return maps
