# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in Blender: load the mesh, unwrap it with the add-on and with Blender's own methods, save mesh and UVs."""

from __future__ import annotations

import importlib
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np

# isort: split
# With the bpy wheel these can be imported only after bpy.
import addon_utils
import bmesh

from tools.demo import suzanne

SPECTRAL = "Spectral Unwrap"
# UV map and table entry -> the call that makes it.
METHODS = {
    SPECTRAL: lambda: bpy.ops.uv.spectral_unwrap(),
    "Blender CONFORMAL": lambda: bpy.ops.uv.unwrap(method="CONFORMAL"),
    "Blender ANGLE_BASED": lambda: bpy.ops.uv.unwrap(method="ANGLE_BASED"),
}
IMPORTERS = {
    ".obj": ("wm.obj_import",),
    ".ply": ("wm.ply_import", "import_mesh.ply"),
    ".stl": ("wm.stl_import", "import_mesh.stl"),
}


def main() -> None:
    """Run the job that the last argument names."""
    job = json.loads(Path(sys.argv[-1]).read_text())
    work = Path(job["work"])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh_file = Path(job["mesh"]) if job["mesh"] else None
    target = load(mesh_file) if mesh_file else suzanne.add_suzanne()
    require_boundary(target.data)
    # From the demonstration's profile; Blender prints the reason of a failure.
    if addon_utils.enable("spectral_unwrap") is None:
        sys.exit("The add-on could not be enabled; the reason is above")
    seconds, uvs = {}, {}
    for name, operator in METHODS.items():
        seconds[name] = unwrap(target, name, operator)
        uvs[name] = corner_uvs(target.data, name)
    target.data.uv_layers.active = target.data.uv_layers[SPECTRAL]
    target.data.uv_layers[SPECTRAL].active_render = True
    save(target, Path(job["output"]))
    vertices, triangles, corners = geometry(target.data)
    np.savez(work / "uvs.npz", vertices=vertices, triangles=triangles, **{k: v[corners] for k, v in uvs.items()})
    facts = {
        "mesh": mesh_file.name if mesh_file else target.name,
        "vertices": len(vertices),
        "faces": len(target.data.polygons),
        "seconds": seconds,
        "blender": bpy.app.version_string,
    }
    (work / "blender.json").write_text(json.dumps(facts))


def load(path: Path) -> bpy.types.Object:
    """Return the meshes of a file as one object; the file's island borders become seams."""
    try:
        read(path)
    # Importers written in Python can raise any exception on a damaged file.
    except Exception as error:  # noqa: BLE001
        sys.exit(f"{path}: Blender cannot read this file: {last_line(error)}")
    suffix = path.suffix.lower()
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    meshes = [item for item in bpy.context.scene.objects if item.type == "MESH" and len(item.data.polygons)]
    if not meshes:
        sys.exit(f"{path}: has no faces")
    for item in bpy.context.scene.objects:
        item.select_set(item in meshes)
    target = max(meshes, key=lambda item: len(item.data.polygons))
    bpy.context.view_layer.objects.active = target
    if suffix != ".blend" and len(meshes) > 1:
        bpy.ops.object.join()
    if target.data.uv_layers.active and not any(edge.use_seam for edge in target.data.edges):
        mark_uv_borders(target.data)
    return target


def read(path: Path) -> None:
    """Let Blender open or import a file."""
    suffix = path.suffix.lower()
    if suffix == ".blend":
        bpy.ops.wm.open_mainfile(filepath=str(path))
        return
    importer = next(find for find in map(operator_named, IMPORTERS[suffix]) if find)
    importer(filepath=str(path))


def last_line(error: Exception) -> str:
    """Return the last line of an error, without the traceback that Blender puts before it."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip() and not line.startswith("Location:")]
    return lines[-1] if lines else type(error).__name__


def operator_named(name: str) -> Callable[..., set[str]] | None:
    """Return the operator, None if this Blender has none of that name."""
    group, function = name.split(".")
    return getattr(getattr(bpy.ops, group), function) if function in dir(getattr(bpy.ops, group)) else None


def mark_uv_borders(mesh: bpy.types.Mesh) -> None:
    """Mark edges as seams if their two faces have different UVs there."""
    edit = bmesh.new()
    edit.from_mesh(mesh)
    layer = edit.loops.layers.uv.active
    for edge in edit.edges:
        if len(edge.link_loops) == 2:
            first, second = edge.link_loops
            ends = ((first, second.link_loop_next), (first.link_loop_next, second))
            edge.seam = any((a[layer].uv - b[layer].uv).length > 1e-6 for a, b in ends)
    edit.to_mesh(mesh)
    edit.free()


def require_boundary(mesh: bpy.types.Mesh) -> None:
    """Stop if the mesh is closed and has no seams: no method can flatten it."""
    edit = bmesh.new()
    edit.from_mesh(mesh)
    if not any(edge.seam or len(edge.link_faces) != 2 for edge in edit.edges):
        sys.exit("The mesh is closed and has neither seams nor UVs: mark seams in Blender and give the saved .blend")
    edit.free()


def unwrap(target: bpy.types.Object, name: str, operator: Callable[[], set[str]]) -> list[float]:
    """Unwrap all faces into a UV map of that name; return the seconds of the operator's first call and of its second.

    The second solves everything again, too: the maps that the add-on keeps of unchanged islands are dropped.
    """
    mesh = target.data
    if name not in mesh.uv_layers:
        # All zero, so that faces which a method skips are visible.
        mesh.uv_layers.new(name=name, do_init=False)
    mesh.uv_layers.active = mesh.uv_layers[name]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.reveal()
    bpy.ops.mesh.select_all(action="SELECT")
    session = importlib.import_module("spectral_unwrap.session")
    kept_maps = importlib.import_module("spectral_unwrap.session.kept_maps")
    durations = []
    for _ in range(2):
        session.drop(kept_maps.KeptMaps)
        start = time.perf_counter()
        result = operator()
        durations.append(time.perf_counter() - start)
        if "FINISHED" not in result:
            sys.exit(f"{name} did not unwrap this mesh; its report is above")
    bpy.ops.object.mode_set(mode="OBJECT")
    return durations


def corner_uvs(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """Return a UV map as (corners, 2)."""
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers[name].data.foreach_get("uv", uv)
    return uv.reshape(-1, 2)


def geometry(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the vertices (V,3), and the triangles as vertices (F,3) and as corners (F,3)."""
    mesh.calc_loop_triangles()
    vertices = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", vertices)
    arrays = []
    for attribute in ("vertices", "loops"):
        values = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get(attribute, values)
        arrays.append(values.reshape(-1, 3))
    return vertices.reshape(-1, 3), *arrays


def save(target: bpy.types.Object, output: Path) -> None:
    """Write the unwrapped mesh as .obj and .blend."""
    for item in bpy.context.scene.objects:
        item.select_set(item == target)
    bpy.context.view_layer.objects.active = target
    bpy.ops.wm.obj_export(filepath=str(output / "mesh.obj"), export_selected_objects=True, export_materials=False)
    bpy.ops.wm.save_as_mainfile(filepath=str(output / "mesh.blend"), compress=True)


if __name__ == "__main__":
    main()
