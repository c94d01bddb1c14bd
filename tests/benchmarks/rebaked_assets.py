# SPDX-License-Identifier: GPL-3.0-or-later
"""How textured assets look before and after the batch, from six sides: a table, and pictures side by side.

    build/venv/bin/python -m tests.benchmarks.rebaked_assets [FOLDER] [asset ...]

Rows of a picture: before, after, and eight times the difference. Those of .blend are renders by Cycles; they need bpy.
A pixel differs by what its worst channel does. Roughness, metal and occlusion are a picture of their own, without
light, where an asset has textures for them.
"""

from __future__ import annotations

import argparse
import importlib.util
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image
from spectral_conformal.batch import settings, task

from tests.benchmarks import blend_scenes
from tests.module import textured_assets as made
from tests.module.scans import fragments
from tests.module.test_gltf_textures import full_sphere

SIZE = 220


def plain_sphere(seed: int, height: int, kind: str = "PNG", **sampler: int) -> made.Textured:
    asset = made.Textured()
    texture = asset.texture(made.encoded(made.painted(height, 3 * height // 2, 3, seed), kind), **sampler)
    asset.add(made.sphere(), asset.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}}))
    return asset


def shifted_sphere(offset: tuple[float, float], **sampler: int) -> made.Textured:
    """The map lies beyond the tile, as far as the sampler makes that the same."""
    asset = made.Textured()
    texture = asset.texture(made.encoded(made.painted(256, 384, 3, 8)), **sampler)
    positions, normals, uv, triangles = made.sphere()
    asset.add(
        (positions, normals, uv + offset, triangles),
        asset.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}}),
    )
    return asset


def boxes(sides: float, change: dict[str, object], **material: str) -> made.Textured:
    asset = made.Textured()
    texture = asset.texture(made.encoded(made.smooth(128, 128, 4, 5)))
    for k, more in enumerate(({}, {"extensions": {made.TRANSFORM: change}})):
        parts = {"pbrMetallicRoughness": {"baseColorTexture": {"index": texture, **more}}, **material}
        asset.add(made.moved(made.box(sides), (1.6 * k, 0, 0)), asset.material(**parts))
    return asset


def two_materials() -> made.Textured:
    """Each on half of the sphere, so that islands may have both."""
    asset, (positions, normals, uv, triangles) = made.Textured(), made.sphere()
    for seed, part in enumerate(np.array_split(triangles, 2)):
        texture = asset.texture(made.encoded(made.painted(256, 384, 3, 30 + seed)))
        number = asset.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}})
        asset.add((positions, normals, uv, part), number)
    return asset


def crossed() -> made.Textured:
    """Two materials read two images: one's colors are the other's roughness, by textures and sets of their own."""
    asset = made.Textured()
    first, second = (asset.texture(made.encoded(made.smooth(128, 128, 3, seed))) for seed in (40, 41))
    asset.build.json["samplers"].append({"wrapS": 33648, "wrapT": 33071})
    again = {"source": asset.build.json["textures"][first]["source"], "sampler": 2}
    asset.build.json["textures"].append(again)
    # The extension's set counts: a reader without it takes the other one.
    to_set = {"index": first, "texCoord": 1, "extensions": {made.TRANSFORM: {"texCoord": 0, "scale": [2.0, 1.5]}}}
    from_set = {"index": second, "extensions": {made.TRANSFORM: {"texCoord": 1, "rotation": 0.4}}}
    surfaces = (
        {"baseColorTexture": to_set, "metallicRoughnessTexture": {"index": second}},
        {"baseColorTexture": from_set, "metallicRoughnessTexture": {"index": 2}},
    )
    for k, surface in enumerate(surfaces):
        mesh = made.moved(made.sphere(), (2.1 * k, 0, 0))
        occlusion = surface["metallicRoughnessTexture"]
        material = asset.material(pbrMetallicRoughness=surface, occlusionTexture=dict(occlusion))
        asset.add(mesh, material, more_uv=[0.5 * mesh[2][:, ::-1] + 0.1])
    return asset


def scan() -> made.Textured:
    """A sphere with colors of vertices, and without a map."""
    asset, (positions, normals, _, triangles) = made.Textured(), made.sphere(40)
    asset.add((positions, normals, np.zeros((len(positions), 2)), triangles), asset.material())
    attributes = asset.primitives[0]["attributes"]
    attributes["COLOR_0"] = asset.build.accessor(0.5 + 0.4 * np.sin(3.0 * positions[:, [1, 2, 0]]))
    del attributes["TEXCOORD_0"]
    return asset


def noisy_pieces() -> made.Textured:
    """A sphere with noise, whose map is in hundreds of pieces, each with a gap around it."""
    asset, (positions, normals, uv, triangles) = made.Textured(), made.sphere(24)
    _, number = np.unique(positions.round(5), axis=0, return_inverse=True)
    edge = np.linalg.norm(positions[triangles[:, 0]] - positions[triangles[:, 1]], axis=1).mean()
    noise = np.random.default_rng(4).normal(size=(number.max() + 1, 3))
    positions = positions + 0.15 * edge * noise[number.ravel()]
    side = np.arange(len(triangles)) // (len(triangles) // 6)
    piece = 1000 * side + fragments(positions, triangles, 300)
    used, corner = np.unique(np.c_[np.repeat(piece, 3), triangles.ravel()], axis=0, return_inverse=True)
    of_piece, vertex = used.T
    _, island = np.unique(of_piece, return_inverse=True)
    middle = np.stack([np.bincount(island, uv[vertex, k]) for k in (0, 1)], axis=1) / np.bincount(island)[:, None]
    apart = middle[island] + 0.96 * (uv[vertex] - middle[island])
    texture = asset.texture(made.encoded(made.painted(512, 768, 3, 6)))
    material = asset.material(pbrMetallicRoughness={"baseColorTexture": {"index": texture}})
    asset.add((positions[vertex], normals[vertex], apart, corner.reshape(-1, 3)), material)
    return asset


def untextured() -> made.Textured:
    asset = made.Textured()
    surface = {"baseColorFactor": [0.8, 0.2, 0.1, 1.0], "roughnessFactor": 0.4, "metallicFactor": 0.1}
    asset.add(made.sphere(), asset.material(pbrMetallicRoughness=surface))
    return asset


def image_and_bumps() -> blend_scenes.Sphere:
    """A .blend with images for the base color, the roughness and the normals."""
    return blend_scenes.Sphere(blend_scenes.image_and_bumps)


def procedural() -> blend_scenes.Sphere:
    """A .blend with textures by formulas of the UVs, which Blender bakes."""
    return blend_scenes.Sphere(blend_scenes.procedural)


TURNED = {"offset": [0.3, -0.2], "rotation": 0.7, "scale": [1.5, 0.8]}
# Made when asked for, with settings of the batch.
ASSETS: dict[str, tuple[Callable[[], made.Textured | blend_scenes.Sphere], dict[str, object]]] = {
    "all textures": (full_sphere, {}),
    "all textures, JPEG": (lambda: full_sphere(kind="JPEG"), {}),
    "with tangents": (lambda: full_sphere(with_tangents=True), {}),
    "kept islands": (full_sphere, {"unwrap": False}),
    "cut as before, turned": (full_sphere, {"seams": "keep", "rotation": "free"}),
    "large texture": (lambda: plain_sphere(6, 1024), {}),
    "small texture": (lambda: plain_sphere(7, 48), {}),
    "nearest": (lambda: plain_sphere(6, 512, magFilter=9728), {}),
    "repeated tile": (lambda: shifted_sphere((3, -2)), {}),
    "clamped": (lambda: shifted_sphere((0, 0), wrapS=33071, wrapT=33071), {}),
    "mirrored": (lambda: shifted_sphere((2, -4), wrapS=33648, wrapT=33648), {}),
    "transformed": (lambda: boxes(2.0, TURNED), {"seams": "keep", "texture_size": 1024}),
    "blended": (lambda: boxes(1.0, TURNED, alphaMode="BLEND"), {"seams": "keep", "texture_size": 1024}),
    "merged islands": (full_sphere, {"seams": "merge"}),
    "merged islands of a noisy scan": (noisy_pieces, {"seams": "merge", "texture_size": 1024}),
    "two materials": (two_materials, {}),
    "crossed references": (crossed, {"seams": "keep", "texture_size": 1024}),
    "scan with vertex colors": (scan, {"rebake_colors": True}),
    "in an atlas": (full_sphere, {}),
    "in an atlas, colors": (two_materials, {}),
    "in an atlas, untextured": (untextured, {}),
    "in an atlas, scan": (scan, {"rebake_colors": True}),
    "blend": (image_and_bumps, {"seams": "keep"}),
    "blend, procedural": (procedural, {"texture_size": 2048}),
    "in an atlas, blend": (image_and_bumps, {}),
}


def compared(name: str, folder: Path) -> str:
    """Unwrap an asset, draw its picture, and return its row of the table."""
    make, values = ASSETS[name]
    place = folder / name.replace(" ", "_").replace(",", "")
    shutil.rmtree(place, ignore_errors=True)
    (place / "out").mkdir(parents=True)
    asset = make()
    is_blend = isinstance(asset, blend_scenes.Sphere)
    name_of_file = "a.blend" if is_blend else "a.glb"
    render = blend_scenes.render if is_blend else made.render
    source, target = asset.save(place / name_of_file), place / "out" / name_of_file
    wanted = settings.from_values({"rebake": "auto", "texture_size": 512, **values}).as_json()
    request = task.Request(name_of_file, str(source), str(place / "out"), str(target), wanted)
    if name.startswith("in an atlas"):
        (place / "other").mkdir()
        other = full_sphere().save(place / "b.glb")
        companion = task.Request("b.glb", str(other), str(place / "other"), str(place / "other" / "b.glb"), wanted)
        report = task.run_atlas(task.Atlas("props", "", [request, companion], str(place)))[0]
    else:
        report = task.run(request)
    (before, covered), (after, _) = render(source, SIZE), render(target, SIZE)
    difference = np.abs(before - after)
    rows = [np.concatenate(list(each[..., :3]), axis=1) for each in (before, after, np.minimum(8 * difference, 255))]
    Image.fromarray(np.concatenate(rows).astype(np.uint8)).save(folder / f"{place.name}.png")
    pictures = np.split(difference[covered], range(3, difference.shape[-1], 3), axis=1)
    cells = [f"{found.mean():.2f}, {100 * (found.max(axis=1) < 8).mean():.2f} %" for found in pictures if found.any()]
    sizes = ", ".join(dict.fromkeys(f"{each['width']}x{each['height']}" for each in report["textures"]))
    return f"| {name} | {report['totals']['islands']} | {sizes} | {' | '.join((cells + ['', ''])[:2])} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("build/rebaked"))
    parser.add_argument("assets", nargs="*", metavar="asset", help=", ".join(ASSETS))
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    print("| asset | islands | textures | difference of 255 on average, pixels below 8 | of roughness and metal |")
    print("|---|---|---|---|---|")
    has_bpy = importlib.util.find_spec("bpy") is not None
    for name in options.assets or [name for name in ASSETS if has_bpy or "blend" not in name.replace("blended", "")]:
        print(compared(name, options.folder), flush=True)


if __name__ == "__main__":
    main()
