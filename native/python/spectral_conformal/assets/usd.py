"""USD files: read the geometry, and write `primvars:st` into the file's own layer or into a layer over it.

This uses Pixar's library, pxr, which `pip install "spectral_conformal[batch]"` installs. It preserves the other content
of a layer, except for comments in text files.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._arguments import doubles
from .._map_change import MapChange
from .._quality import face_triangles
from .._texture_size import DrawnTexture, TextureSize
from .._vertex_colors import NAME, VertexColors
from . import images, references
from .edits import numbered
from .mesh import AssetError, AssetMesh, NoMeshError, UvMap, checked, of_short_faces, offsets_of
from .shared_textures import BASE_COLOR, Colors, SharedTextures
from .usd_textures import (
    DISPLAY_COLOR,
    READERS,
    Redrawing,
    bind,
    color_by,
    color_material,
    materials,
    places,
    reads_colors,
)

if TYPE_CHECKING:
    from pxr import Sdf, Usd, UsdGeom, UsdShade, Vt

_UV = "st"
_BINARY = b"PXR-USDC"
# Metadata of a layer itself, and of how it is composed.
_OF_LAYER = ("comment", "documentation", "customLayerData", "subLayers", "subLayerOffsets", "layerRelocates")


class UsdAsset:
    """A USD file: its meshes; prototypes of instances count once."""

    def __init__(self, path: Path, uv_map: str = "", *, over: bool = False) -> None:
        """Read the file and the layers that it is composed of.

        Args:
            path: of a .usd, .usda, .usdc or .usdz file.
            uv_map: name of the primvar to read and write; by default the one that the mesh's material reads, or "st".
            over: write UVs into a layer over the file, which then stays unchanged.

        Raises:
            AssetError: pxr is missing, the content is broken, or there is no mesh.
        """
        try:
            from pxr import Tf
        except ImportError as error:
            needed = 'pip install "spectral_conformal[batch]"'
            raise AssetError(f"{path}: USD needs Pixar's library: {needed}, or usd-core.") from error
        self.path = path
        self.suffix = ".usda" if over else path.suffix.lower()
        self.warnings: list[str] = []
        self.drawn_textures: list[DrawnTexture] = []
        """Textures that `files` drew last."""
        self.shared: SharedTextures | None = None
        """Textures that it reads instead of its own."""
        self._redrawing: Redrawing | None = None
        self._colors_record: DrawnTexture | None = None
        self._over = over
        self._named_anew: set[str] = set()
        self.uv_map = uv_map
        self.material_numbers: dict[str, int] = {}
        """Of materials, by their paths."""
        with _named(path, Tf.ErrorException):
            self._read(path)

    def _read(self, path: Path) -> None:
        from pxr import Sdf, Usd, UsdGeom

        # The library keeps the content of files that it has read, such as that of a source written over since.
        for layer in Sdf.Layer.GetLoadedLayers():
            # Reloading a package ends layers within it.
            if layer and layer.realPath and Path(layer.realPath.partition("[")[0]) == path.resolve():
                layer.Reload(force=True)
        self._stage = Usd.Stage.Open(str(path))
        self.meters: float | None = UsdGeom.GetStageMetersPerUnit(self._stage)
        self._left: list[_Mesh] = []
        self._varying: dict[Sdf.Path, Sdf.Path] = {}
        """The path of each mesh that has other faces in variants that are not selected, within the one that is."""
        self._others: set[Sdf.Path] = set()
        """Those meshes there."""
        self._find_variants()
        self._meshes = [_Mesh(self, prim) for prim in self._prims()]
        if not self._meshes:
            raise NoMeshError(f"{path}: has no meshes; there is nothing to unwrap.")
        self._name_variants()
        if all(mesh.has_varying_faces for mesh in self._meshes):
            raise AssetError(f"{path}: the faces of its meshes change over time, which no single map fits.")
        self._leave_out(lambda mesh: mesh.has_varying_faces, "their faces change over time, which no single map fits")
        self._leave_out(lambda mesh: mesh.is_aid, "they are guides or proxies")
        self._leave_out(lambda mesh: mesh.is_never_seen, "they are abstract or inactive")
        filled = [mesh for mesh in self._meshes if mesh.n_faces]
        if filled:
            for mesh in self._meshes:
                if not mesh.n_faces:
                    self._warn(f"{mesh.place} has no faces.")
            self._meshes = filled
        elif not any(mesh.n_short for mesh in self._meshes):
            raise NoMeshError(f"{path}: has no faces; there is nothing to unwrap.")
        self.meshes = [checked(path, mesh.polygons()) for mesh in self._meshes]
        self.warnings += of_short_faces(sum(mesh.n_short for mesh in self._meshes), "no UVs for them")
        self._notes = list(self.warnings)

    def _prims(self) -> list[tuple[Usd.Prim, Sdf.Path]]:
        """Return the prim of each mesh, and the path at which an opinion on it holds for all of its instances."""
        from pxr import Usd, UsdGeom

        found: dict[Sdf.Path, Usd.Prim] = {}
        for prim in self._stage.Traverse(Usd.TraverseInstanceProxies(Usd.PrimAllPrimsPredicate)):
            if not prim.IsA(UsdGeom.Mesh):
                continue
            place = self._own_path(prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim)
            if place is None and prim.IsInstanceProxy():
                self._warn(f"{prim.GetPath()} is an instance of another file's prim and has no UVs: unwrap that file.")
                continue
            place = place or prim.GetPath()
            # Instances of a class are no classes.
            if place not in found or _is_never_seen(found[place]):
                found[place] = prim
        return [(prim, place) for place, prim in found.items()]

    def _own_path(self, prim: Usd.Prim) -> Sdf.Path | None:
        """Return the path at which the file itself describes a prim, maybe in a variant; None if only others do."""
        root = self._stage.GetRootLayer()
        found = [spec for spec in prim.GetPrimStack() if spec.layer == root]
        inside = self._varying.get(prim.GetPath())
        # A map outside of the variants would be stronger than one in a variant.
        if inside:
            name = self.uv_map or _uv_name(_primvars_read(prim))
            if not (found and f"primvars:{name}" in found[0].attributes):
                return inside
        return found[0].path if found else None

    def _find_variants(self) -> None:
        """Find the meshes that have other faces, or none, where another variant of the file is selected."""
        from pxr import Sdf, Usd

        root = self._stage.GetRootLayer()
        for prim in self._stage.Traverse(Usd.PrimAllPrimsPredicate):
            spec = root.GetPrimAtPath(prim.GetPath())
            for name, variants in spec.variantSets.items() if spec else ():
                place, selected = prim.GetPath(), prim.GetVariantSet(name).GetVariantSelection()
                own, found = _faces_below(prim), {}
                for variant in (each.name for each in variants.variants.values() if each.name != selected):
                    session = Sdf.Layer.CreateAnonymous()
                    Sdf.CreatePrimInLayer(session, place).variantSelections[name] = variant
                    stage = Usd.Stage.OpenMasked(root, session, Usd.StagePopulationMask([place]))
                    found[variant] = _faces_below(stage.GetPrimAtPath(place))
                differing = {path for each in found.values() for path, faces in each.items() if own.get(path) != faces}
                for variant, meshes in found.items():
                    self._others.update(_within(path, place, name, variant) for path in meshes.keys() & differing)
                for path in own.keys() & differing if selected else ():
                    self._varying[path] = _within(path, place, name, selected)

    def _name_variants(self) -> None:
        """Warn of the file's meshes in variants that are not selected."""
        from pxr import Sdf

        layer, own, others = self._stage.GetRootLayer(), {mesh.place for mesh in self._meshes}, set(self._others)

        def visit(path: Sdf.Path) -> None:
            if path.IsPrimPath() and path.ContainsPrimVariantSelection() and path not in own:
                spec = layer.GetPrimAtPath(path)
                if spec and spec.typeName == "Mesh" and spec.specifier == Sdf.SpecifierDef:
                    others.add(path)

        layer.Traverse(Sdf.Path.absoluteRootPath, visit)
        if others:
            named = ", ".join(str(path) for path in sorted(others))
            self._warn(f"Left unchanged, because their variants are not selected: {named}.")

    def _leave_out(self, is_left: Callable[[_Mesh], bool], why: str) -> None:
        """Leave out meshes, with a warning, if there are others."""
        left = [str(mesh.place) for mesh in self._meshes if is_left(mesh)]
        if left and len(left) < len(self._meshes):
            self._left += [mesh for mesh in self._meshes if is_left(mesh)]
            self._meshes = [mesh for mesh in self._meshes if not is_left(mesh)]
            self._warn(f"Left unchanged, because {why}: {', '.join(left)}.")

    def _warn(self, warning: str) -> None:
        if warning not in self.warnings:
            self.warnings.append(warning)

    def references(self) -> Iterator[str]:
        """Yield the layers and assets that the file is composed of, without those that `files` renamed.

        A package and a layer over a file need none.
        """
        from pxr import UsdUtils

        if self._over or self.suffix == ".usdz":
            return
        layers, others, _ = UsdUtils.ComputeAllDependencies(str(self.path))
        for found in [layer.realPath for layer in layers] + list(others):
            name = Path(os.path.relpath(found, self.path.resolve().parent)).as_posix() if found else ""
            if name not in ("", self.path.name, *self._named_anew):
                yield name
                if name.lower().endswith(".mtlx"):
                    folder = PurePosixPath(name).parent
                    yield from (str(folder / each) for each in references.textures_of_materialx(Path(found)))

    def rename(self, source: Path, copy: Path, named: Callable[[str], str]) -> None:
        """Change the paths in the copy of a layer."""
        from pxr import Sdf, UsdUtils

        if not Sdf.FileFormat.FindByExtension(source.suffix[1:].lower()) or source.suffix.lower() == ".usdz":
            return
        changed = []

        def renamed(path: str) -> str:
            new = named(path)
            changed.extend([new] if new != path else [])
            return new

        layer = Sdf.Layer.CreateAnonymous(".usda")
        layer.TransferContent(Sdf.Layer.FindOrOpen(str(source)))
        UsdUtils.ModifyAssetPaths(layer, renamed)
        if changed:
            _export(layer, copy, source.read_bytes())

    def files(
        self, out: Path, maps: Sequence[UvMap], textures: TextureSize | None = None
    ) -> Mapping[Path, Iterable[bytes]]:
        """Return the file with new UVs, or the layer over it, by its path.

        With `textures`, those that read the primvars are drawn anew, into files beside it or in the package.
        """
        self.warnings, self.drawn_textures = list(self._notes), []
        self._colors_record = None
        colors = self._colors_of(maps) if textures and textures.colors else None
        redrawing, self._redrawing = self._redrawing, None
        # Textures drawn anew are read as they are.
        if not (textures or redrawing) and any(mesh.is_placed_by_materials for mesh in self._meshes):
            self._warn("Materials scale, turn or move textures of the map, which was left.")
        if textures and not redrawing:
            redrawing = self._added(Redrawing(textures), maps)
        new: dict[Path, Iterable[bytes]] = {}

        def drawn(layer: Sdf.Layer) -> Sdf.Layer:
            if redrawing:

                def named(name: str) -> Path:
                    taken = {path.name for path in new}
                    return references.free_beside(out, f"{out.stem}_{name}", self.path, taken)

                folder = None if self.suffix == ".usdz" else out.parent
                new.update((path, [content]) for path, content in redrawing.draw(layer, named, folder))
                if colors:
                    self._color_by(layer, self._stored_colors(colors, textures, named, folder, new))
            return layer

        with tempfile.TemporaryDirectory() as folder:
            target = Path(folder) / f"layer{self.suffix}"
            if self._over:
                drawn(self._layer_over(out, maps)).Export(str(target))
            elif self.suffix == ".usdz":
                self._write_package(target, drawn(self._layer(maps)), new)
                new = {}
            else:
                layer = self._layer(maps)
                self._name_from(layer, out)
                _export(drawn(layer), target, self.path.read_bytes())
            if not target.is_file():
                raise OSError(f"{out}: USD's library could not write it; is the disk full?")
            if redrawing:
                self.warnings += redrawing.warnings
                records = [*redrawing.drawn, *([self._colors_record] if self._colors_record else [])]
                self.drawn_textures = list(dict.fromkeys(records))
            return {**new, out: [target.read_bytes()]}

    def share(self, out: Path, maps: Sequence[UvMap], textures: TextureSize, shared: SharedTextures) -> None:  # noqa: ARG002 - as for other formats
        """Add its textures to those that assets share; `files` with the same arguments then names these."""
        self.shared = shared
        self._redrawing = self._added(Redrawing(textures, shared), maps)
        self._redrawing.share()
        colors = self._colors_of(maps) if textures.colors else None
        if colors:
            shared.add(BASE_COLOR, Colors(colors), NAME, self._warn)

    def _colors_of(self, maps: Sequence[UvMap]) -> VertexColors:
        """Return the colors of the meshes that show them, for one texture of the whole map."""
        colors = VertexColors("color")
        for mesh, uv_map in zip(self._meshes, maps):
            mesh.add_colors(colors, uv_map)
        return colors

    def _stored_colors(
        self,
        colors: VertexColors,
        size: TextureSize,
        named: Callable[[str], Path],
        folder: Path | None,
        new: dict[Path, Iterable[bytes]],
    ) -> str:
        """Return the name of the texture of the colors, added to the `new` files unless it is shared with others."""
        shared = self.shared.find(BASE_COLOR) if self.shared else None
        self._colors_record = shared.record if shared else None
        if shared and folder:
            return shared.name_from(folder)
        if shared:
            packed = next((path for path, content in new.items() if content == [shared.content]), None)
            path = packed or named(shared.path.name)
            new[path] = [shared.content]
            return path.name
        baked = colors.drawn(size)
        path = named(f"{NAME}.png")
        new[path] = [images.written(baked.image, ".png")]
        self._colors_record = DrawnTexture.of(NAME, baked)
        return path.name

    def _color_by(self, layer: Sdf.Layer, file: str) -> None:
        """Let the meshes that show the colors of their vertices read a texture instead."""
        made: dict[Sdf.Path, Sdf.Path] = {}
        for mesh in self._meshes:
            mesh.color_by(layer, file, made)

    def _added(self, redrawing: Redrawing, maps: Sequence[UvMap]) -> Redrawing:
        """Add the meshes with their new maps."""
        for mesh, uv_map in zip(self._meshes, maps):
            mesh.add_to(redrawing, uv_map)
        for mesh in self._left:
            for material, _ in mesh._faces_of_materials():
                redrawing.note_left(material, mesh.place)
        return redrawing

    def _layer(self, maps: Sequence[UvMap]) -> Sdf.Layer:
        """Return the file's own layer with new UVs."""
        from pxr import Sdf

        root = self._stage.GetRootLayer()
        layer = Sdf.Layer.CreateAnonymous(".usda")
        layer.TransferContent(root)
        return self._with_maps(layer, maps)

    def _name_from(self, layer: Sdf.Layer, out: Path) -> None:
        """Adapt a layer's relative paths to files above its folder, for writing it to another folder."""
        from pxr import UsdUtils

        def named(path: str) -> str:
            new = references.elsewhere(path, self.path, out) if path else path
            if new != path:
                self._named_anew.add(Path(os.path.normpath(path)).as_posix())
            return new

        UsdUtils.ModifyAssetPaths(layer, named)

    def _layer_over(self, out: Path, maps: Sequence[UvMap]) -> Sdf.Layer:
        """Return a layer over the file that contains only UVs."""
        from pxr import Sdf

        root = self._stage.GetRootLayer()
        layer = Sdf.Layer.CreateAnonymous(".usda")
        layer.subLayerPaths.append(Path(os.path.relpath(self.path, out.parent)).as_posix())
        # A stage has the metadata of its root layer alone, such as the time codes per second.
        for key in root.pseudoRoot.ListInfoKeys():
            if key not in _OF_LAYER:
                layer.pseudoRoot.SetInfo(key, root.pseudoRoot.GetInfo(key))
        return self._with_maps(layer, maps)

    def _with_maps(self, layer: Sdf.Layer, maps: Sequence[UvMap]) -> Sdf.Layer:
        for mesh, uv_map in zip(self._meshes, maps):
            mesh.write(layer, uv_map)
        return layer

    def _write_package(self, target: Path, layer: Sdf.Layer, new: Mapping[Path, Iterable[bytes]]) -> None:
        """Write a package of the same files in the same order, first the layer of the meshes, and of new ones."""
        from pxr import Sdf

        package = Sdf.ZipFileWriter.CreateNew(str(target))
        with zipfile.ZipFile(self.path) as content:
            for number, name in enumerate(content.namelist()):
                path = target.parent / f"{number}{Path(name).suffix}"
                if number == 0:
                    _export(layer, path, content.read(name))
                else:
                    path.write_bytes(content.read(name))
                package.AddFile(str(path), name)
            # Beside the layer, which names them so.
            folder = PurePosixPath(content.namelist()[0]).parent
        for number, (path, pieces) in enumerate(new.items()):
            file = target.parent / f"new {number}{path.suffix}"
            file.write_bytes(b"".join(pieces))
            package.AddFile(str(file), (folder / path.name).as_posix())
        package.Save()


def _export(layer: Sdf.Layer, path: Path, origin: bytes) -> None:
    """Write a layer as text or binary, like its source: the suffix .usd allows both."""
    is_binary = origin.startswith(_BINARY)
    layer.Export(str(path), args={"format": "usdc" if is_binary else "usda"} if path.suffix == ".usd" else {})


def _faces_below(prim: Usd.Prim) -> dict[Sdf.Path, tuple[Vt.IntArray | None, Vt.IntArray | None]]:
    """Return the faces of each mesh that is a prim or below it, in the first state."""
    from pxr import Usd, UsdGeom

    meshes = [UsdGeom.Mesh(each) for each in Usd.PrimRange(prim) if each.IsA(UsdGeom.Mesh)]
    first = Usd.TimeCode.EarliestTime()
    return {
        each.GetPath(): (each.GetFaceVertexCountsAttr().Get(first), each.GetFaceVertexIndicesAttr().Get(first))
        for each in meshes
    }


def _within(path: Sdf.Path, prim: Sdf.Path, name: str, variant: str) -> Sdf.Path:
    """Return the path of a prim, or of one below it, in one of its variants."""
    return path.ReplacePrefix(prim, prim.AppendVariantSelection(name, variant))


def _is_never_seen(prim: Usd.Prim) -> bool:
    """Return whether a prim is only there for others, or is turned off."""
    return prim.IsAbstract() or not prim.IsActive()


def _uv_name(read: Mapping[Sdf.Path, Sequence[str]]) -> str:
    """Return the primvar for UVs, given those that materials read; "st" if in doubt."""
    names = [name for each in read.values() for name in each]
    return _UV if _UV in names or not names else names[0]


def _primvars_read(prim: Usd.Prim) -> dict[Sdf.Path, list[str]]:
    """Return the primvars that each material of a mesh and its parts reads as UVs."""
    from pxr import Usd, UsdGeom, UsdShade

    parts = [subset.GetPrim() for subset in UsdGeom.Subset.GetAllGeomSubsets(UsdGeom.Imageable(prim))]
    result: dict[Sdf.Path, list[str]] = {}
    for part in (prim, *parts):
        material = UsdShade.MaterialBindingAPI(part).ComputeBoundMaterial()[0]
        for each in Usd.PrimRange(material.GetPrim()) if material else ():
            shader = UsdShade.Shader(each)
            if each.IsA(UsdShade.Shader) and shader.GetShaderId() in READERS:
                name = shader.GetInput(READERS[shader.GetShaderId()])
                values = [found.Get() for found in UsdShade.Utils.GetValueProducingAttributes(name)] if name else []
                result.setdefault(material.GetPath(), []).extend(str(value) for value in values if value)
    return result


def _rows(found: object, width: int) -> npt.NDArray[np.float64]:
    """Return the values of an attribute as rows of so many numbers; none if they are of another type."""
    try:
        values = doubles([] if found is None else found)
    except (TypeError, ValueError):
        values = np.zeros(0)
    return values[:, :width] if values.ndim == 2 and values.shape[1] >= width else np.zeros((0, width))


@contextlib.contextmanager
def _named(path: Path, kind: type[Exception]) -> Iterator[None]:
    """Raise AssetError where the library raises its own kind, which it also does while it reads values."""
    try:
        yield
    except kind as error:
        # Each of its parts says less than the one before, the last only that the file could not be opened.
        reason = next(filter(None, map(_text_of, error.args)), "it is damaged")
        reason = reason.strip().replace(f"{path}:", "line ").removesuffix(".")
        raise AssetError(f"{path}: is not a USD file that can be read: {reason}.") from None


def _text_of(part: object) -> str:
    """Return what a part of the library's errors says, empty if it quotes bytes that are no text."""
    try:
        return getattr(part, "commentary", "") or str(part)
    except UnicodeDecodeError:
        return ""


class _Mesh:
    def __init__(self, asset: UsdAsset, found: tuple[Usd.Prim, Sdf.Path]) -> None:
        from pxr import Usd, UsdGeom

        self._asset = asset
        prim, self.place = found
        self.is_never_seen = _is_never_seen(prim)
        read = {} if asset.uv_map else _primvars_read(prim)
        self._name = asset.uv_map or _uv_name(read)
        for path, names in read.items():
            if names and self._name not in names:
                only = f"only {', '.join(sorted(set(names)))}: name that as the UV map to show the new one."
                asset._warn(f"No texture of {path} reads {self._name}, {only}")
        self._mesh: UsdGeom.Mesh = UsdGeom.Mesh(prim)
        self._time = Usd.TimeCode.EarliestTime()
        if self._mesh.GetPointsAttr().GetNumTimeSamples() > 1:
            asset._warn(f"{prim.GetPath()} is animated: it was unwrapped in its first state.")
        self._positions = self._numbers(self._mesh.GetPointsAttr(), np.float64).reshape(-1, 3)
        sizes = self._numbers(self._mesh.GetFaceVertexCountsAttr(), np.int64)
        indices = self._numbers(self._mesh.GetFaceVertexIndicesAttr(), np.int64)
        if sizes.min(initial=0) < 0:
            raise AssetError(f"{asset.path}: {prim.GetPath()}: face {int(sizes.argmin())} has {sizes.min()} corners.")
        if sizes.sum() != len(indices):
            raise AssetError(f"{asset.path}: {prim.GetPath()}: the faces' numbers of corners and the indices disagree.")
        if len(indices) and not 0 <= indices.min() <= indices.max() < len(self._positions):
            raise AssetError(f"{asset.path}: {prim.GetPath()}: an index names a point that does not exist.")
        # The corners of the file's faces in the order of a counterclockwise winding.
        self._order = np.arange(len(indices))
        if self._mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded:
            offsets = offsets_of(sizes)
            self._order = np.repeat(offsets[:-1] + offsets[1:] - 1, sizes) - self._order
        # Of the file's faces, those that a map can have.
        self._is_face = sizes >= 3
        self._order = self._order[np.repeat(self._is_face, sizes)]
        self._offsets = offsets_of(sizes[self._is_face])
        self._indices = indices
        self._surfaces: list[Sdf.Path | None] = []
        """That show the colors of vertices; None for that of a material of its own."""

    @property
    def has_varying_faces(self) -> bool:
        """Whether the faces at some time have other corners than in the first state."""
        return any(
            not np.array_equal(np.array(attribute.Get(time)), first)
            for attribute in (self._mesh.GetFaceVertexCountsAttr(), self._mesh.GetFaceVertexIndicesAttr())
            for first in [self._numbers(attribute, np.int64)]
            for time in attribute.GetTimeSamples()[1:]
        )

    @property
    def is_aid(self) -> bool:
        """Whether the mesh is a guide or a proxy, which no final render shows."""
        return self._mesh.ComputePurpose() in ("guide", "proxy")

    @property
    def n_faces(self) -> int:
        """Number of faces of at least three corners."""
        return len(self._offsets) - 1

    @property
    def n_short(self) -> int:
        """Number of other faces."""
        return int((~self._is_face).sum())

    def _numbers(self, attribute: Usd.Attribute, kind: type) -> npt.NDArray:
        found = attribute.Get(self._time)
        values = [] if found is None else found
        return doubles(values) if kind is np.float64 else np.array(values, kind)

    def polygons(self) -> AssetMesh:
        """Return the mesh, wound counterclockwise."""
        from pxr import UsdGeom

        matrix = np.array(UsdGeom.XformCache(self._time).GetLocalToWorldTransform(self._mesh.GetPrim()))
        material = self._materials()
        return AssetMesh(
            self._positions,
            self._offsets,
            self._indices[self._order],
            self._uv(),
            str(self.place.StripAllVariantSelections()),
            matrix.T,
            material_of_face=material if (material != material[:1]).any() else None,
            material=int(material[0]) if len(material) else -1,
        )

    def _materials(self) -> npt.NDArray[np.int64]:
        """Return the number of each face's material within the asset, (faces,), -1 for none."""
        from pxr import UsdGeom, UsdShade

        def number(prim: Usd.Prim) -> int:
            material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
            numbers = self._asset.material_numbers
            return numbers.setdefault(str(material.GetPath()), len(numbers)) if material else -1

        result = np.full(len(self._is_face), number(self._mesh.GetPrim()), np.int64)
        for subset in UsdGeom.Subset.GetAllGeomSubsets(UsdGeom.Imageable(self._mesh.GetPrim())):
            faces = self._numbers(subset.GetIndicesAttr(), np.int64)
            found = number(subset.GetPrim())
            if found >= 0 and subset.GetElementTypeAttr().Get() == UsdGeom.Tokens.face:
                result[faces[(faces >= 0) & (faces < len(result))]] = found
        return result[self._is_face]

    def _faces_of_materials(self) -> Iterator[tuple[UsdShade.Material, npt.NDArray[np.bool_]]]:
        """Yield the materials, with the faces, (faces,), that show each."""
        for material, faces in materials(self._mesh.GetPrim(), len(self._is_face)):
            yield material, faces[self._is_face]

    def _uv(self) -> npt.NDArray[np.float64] | None:
        from pxr import UsdGeom

        variable = UsdGeom.PrimvarsAPI(self._mesh).GetPrimvar(self._name)
        found = variable.ComputeFlattened(self._time) if variable and variable.HasValue() else None
        uv = _rows(found, 2)
        if not len(uv):
            return None
        tokens, by = UsdGeom.Tokens, variable.GetInterpolation()
        if by == tokens.faceVarying and len(uv) == len(self._indices):
            return uv[self._order]
        if by in (tokens.vertex, tokens.varying) and len(uv) == len(self._positions):
            return uv[self._indices[self._order]]
        return None

    def add_to(self, redrawing: Redrawing, uv_map: UvMap) -> None:
        """Add the faces of each material with both maps to the textures to draw."""
        old = self._uv()
        vertices, corners = self._positions, self._indices[self._order]
        normals = self._normals()
        for material, faces in self._faces_of_materials():
            chosen = faces & uv_map.mapped
            triangles, _ = face_triangles(vertices, self._offsets, corners, selected_faces=chosen)
            change = MapChange(uv_map.uv if old is None else old, uv_map.uv, triangles, vertices[corners], normals)
            redrawing.add(material, self._name, change.part(triangles), old is not None)

    @property
    def is_placed_by_materials(self) -> bool:
        """Whether a material scales, turns or moves textures that read the map."""
        return any(places(material, self._name) for material, _ in self._faces_of_materials())

    def add_colors(self, colors: VertexColors, uv_map: UvMap) -> None:
        """Add the colors of the faces that show them, and note by which materials."""
        self._surfaces = []
        values = self._colors()
        if values is None:
            return
        shown = np.zeros(self.n_faces, bool)
        bound = np.zeros(self.n_faces, bool)
        for material, faces in self._faces_of_materials():
            bound |= faces
            if reads_colors(material):
                shown |= faces
                self._surfaces.append(material.ComputeSurfaceSource()[0].GetPath())
        if not bound.any():
            # Without a material, the colors are what shows.
            shown[:] = True
            self._surfaces.append(None)
        corners = self._indices[self._order]
        chosen = shown & uv_map.mapped
        triangles, _ = face_triangles(self._positions, self._offsets, corners, selected_faces=chosen)
        colors.add(values, uv_map.uv, triangles)

    def color_by(self, layer: Sdf.Layer, file: str, made: dict[Sdf.Path, Sdf.Path]) -> None:
        """Let a texture on the new map give the colors that `add_colors` found.

        Args:
            layer: to be changed.
            file: name of the texture.
            made: the material of each prim that got one; its children without a material share it.
        """
        for surface in self._surfaces:
            if surface is not None:
                if surface not in made:
                    color_by(layer, surface, file, self._name)
                    made[surface] = surface
                continue
            # Beside the mesh, so that it goes along where the file is referenced; a root prim holds its own.
            folder = self.place.GetParentPath() if self.place.pathElementCount > 1 else self.place
            key = folder.AppendChild(self._name)
            if key not in made:
                made[key] = folder.AppendChild(NAME)
                color_by(layer, color_material(layer, made[key]), file, self._name)
            bind(layer, self.place, made[key])

    def _colors(self) -> npt.NDArray[np.float64] | None:
        """Return the colors of corners, (C, 3), as light; None if there are none, or one for all."""
        from pxr import UsdGeom

        variable = UsdGeom.PrimvarsAPI(self._mesh).GetPrimvar(DISPLAY_COLOR)
        found = variable.ComputeFlattened(self._time) if variable and variable.HasValue() else None
        values = _rows(found, 3)
        tokens, by = UsdGeom.Tokens, variable.GetInterpolation()
        corners = self._indices[self._order]
        if by == tokens.uniform and len(values) == len(self._is_face):
            return np.repeat(values[self._is_face], np.diff(self._offsets), axis=0)
        if by == tokens.faceVarying and len(values) == len(self._indices):
            return values[self._order]
        if by in (tokens.vertex, tokens.varying) and len(values) == len(self._positions):
            return values[corners]
        return None

    def _normals(self) -> npt.NDArray[np.float64] | None:
        """Return the normals of the corners, (C, 3), that renders use; None for those of the faces."""
        from pxr import UsdGeom

        tokens = UsdGeom.Tokens
        corners = self._indices[self._order]
        variable = UsdGeom.PrimvarsAPI(self._mesh).GetPrimvar("normals")
        if variable and variable.HasValue():
            found, by = variable.ComputeFlattened(self._time), variable.GetInterpolation()
        else:
            found, by = self._mesh.GetNormalsAttr().Get(self._time), self._mesh.GetNormalsInterpolation()
        normals = _rows(found, 3)
        if self._mesh.GetSubdivisionSchemeAttr().Get() != tokens.none:
            # Subdivided surfaces are smooth, whatever their normals say.
            triangles, _ = face_triangles(self._positions, self._offsets, corners)
            first, second, third = (self._positions[corners[triangles[:, k]]] for k in range(3))
            normals, by = np.zeros_like(self._positions), tokens.vertex
            for k in range(3):
                np.add.at(normals, corners[triangles[:, k]], np.cross(second - first, third - first))
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
        if by == tokens.faceVarying and len(normals) == len(self._indices):
            return normals[self._order]
        if by in (tokens.vertex, tokens.varying) and len(normals) == len(self._positions):
            return normals[corners]
        return None

    def write(self, layer: Sdf.Layer, uv_map: UvMap) -> None:
        """Write the map into a layer; it replaces an existing map with all of its time samples."""
        from pxr import Sdf, UsdGeom, Vt

        mapped = np.repeat(uv_map.mapped, np.diff(self._offsets))
        # Faces without a map lie at the origin, because a primvar must be complete.
        uv = np.zeros((len(self._indices), 2), np.float32)
        uv[self._order[mapped]] = uv_map.uv[mapped]
        first, index = numbered(self._indices, uv)
        different = uv[first]
        prim = Sdf.CreatePrimInLayer(layer, self.place)
        names = (f"primvars:{self._name}", f"primvars:{self._name}:indices")
        kinds = (Sdf.ValueTypeNames.TexCoord2fArray, Sdf.ValueTypeNames.IntArray)
        values = (Vt.Vec2fArray.FromNumpy(different), Vt.IntArray.FromNumpy(index))
        for name, kind, value in zip(names, kinds, values):
            old = prim.attributes.get(name)
            if old is not None and old.typeName != kind:
                del prim.properties[name]
                old = None
            attribute = old or Sdf.AttributeSpec(prim, name, kind)
            for time in layer.ListTimeSamplesForPath(attribute.path):
                layer.EraseTimeSample(attribute.path, time)
            attribute.default = value
        prim.attributes[names[0]].SetInfo("interpolation", UsdGeom.Tokens.faceVarying)
