# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF files with all possible content: writing UVs changes nothing else."""

import base64
import copy
import itertools
import json
import re
import struct
from pathlib import Path

import numpy as np
import pytest
from spectral_conformal import assets

from tests.module import meshes

COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
WIDTHS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
PICTURE = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNgAAAAAgABSK+kcQAAAABJRU5ErkJggg=="
)


UNREAD = "No texture reads TEXCOORD_0, only TEXCOORD_1: name that as the UV map to show the new one."


class Builder:
    """A document and its buffer."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0", "generator": "tests"}, "accessors": [], "bufferViews": []}
        self.buffer = b""

    def view(self, data, **more):
        self.buffer += bytes(-len(self.buffer) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data), **more})
        self.buffer += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values, kind="f4", view=None, offset=0, **more):
        values = np.atleast_2d(np.asarray(values, "<" + kind))
        if view is None:
            view = self.view(values.tobytes())
        new = {"componentType": COMPONENTS[kind], "count": len(values), "type": WIDTHS[values.shape[1]], **more}
        self.json["accessors"].append({"bufferView": view, **({"byteOffset": offset} if offset else {}), **new})
        return len(self.json["accessors"]) - 1


def grid(n):
    """(n + 1)^2 vertices of a bumpy sheet, and its triangles."""
    points, quads = meshes.unit_square(n + 1)
    u, v = np.rint(n * points).T
    return np.c_[u, v, np.sin(u) * np.cos(v) / 3].astype("f4"), meshes.triangles_of(quads)


def everything():
    """Everything that a file may have beside its geometry, and geometry in every form."""
    build, rng = Builder(), np.random.default_rng(0)
    places, triangles = grid(4)
    n = len(places)
    normals = rng.normal(size=(n, 3)).astype("f4")
    # Positions and normals side by side, and colors of three bytes in rows of four.
    woven = build.view(np.c_[places, normals].astype("<f4").tobytes(), byteStride=24)
    colors = build.view(np.c_[rng.integers(0, 255, (n, 3)), np.zeros(n)].astype("u1").tobytes(), byteStride=4)
    attributes = {
        "POSITION": build.accessor(places, view=woven, min=places.min(0).tolist(), max=places.max(0).tolist()),
        "NORMAL": build.accessor(normals, view=woven, offset=12),
        "COLOR_0": build.accessor(np.zeros((n, 3)), "u1", view=colors, normalized=True),
        "TEXCOORD_0": build.accessor(rng.random((n, 2))),
        "TEXCOORD_1": build.accessor(rng.integers(0, 65535, (n, 2)), "u2", normalized=True),
        "JOINTS_0": build.accessor(rng.integers(0, 2, (n, 4)), "u1"),
        "WEIGHTS_0": build.accessor(rng.random((n, 4))),
        "_FEATURE_ID_0": build.accessor(np.arange(n)[:, None]),
    }
    moved = build.accessor(rng.random((n, 3)), name="moved", extras={"kept": True})
    # Zeros, but for two.
    indices, values = build.view(np.array([3, 7], "<u2").tobytes()), build.view(np.ones((2, 3), "<f4").tobytes())
    sparse = {"indices": {"bufferView": indices, "componentType": 5123}, "values": {"bufferView": values}, "count": 2}
    build.json["accessors"].append({"componentType": 5126, "count": n, "type": "VEC3", "sparse": sparse})
    targets = [{"POSITION": moved, "NORMAL": len(build.json["accessors"]) - 1}]
    half = len(triangles) // 2
    strip, fan = np.arange(6)[:, None], np.array([0, 1, 2, 3, 4])[:, None]
    flat = np.array([(0, 0, 5), (0, 1, 5), (1, 0, 5), (1, 1, 5), (2, 0, 5), (2, 1, 5)], "f4")
    round_ = np.array([(9, 0, 0), (10, 0, 0), (10, 1, 0), (9, 1, 0.5), (8, 1, 0)], "f4")
    lines = build.accessor(rng.random((4, 3)))
    shared = {"attributes": attributes, "targets": targets}
    parts = [
        {**shared, "material": k, "extras": {"part": k}, "indices": build.accessor(each.reshape(-1, 1), "u1")}
        for k, each in enumerate([triangles[:half], triangles[half:]])
    ]
    again = {"attributes": {**attributes}, "indices": build.accessor(triangles.reshape(-1, 1), "u4")}
    strips = [{"attributes": {"POSITION": build.accessor(places)}, "mode": 5} for places in (flat, flat + 3)]
    strips[1]["indices"] = build.accessor(strip, "u1")
    rays = {"attributes": {"POSITION": build.accessor(round_)}, "mode": 6, "indices": build.accessor(fan, "u2")}
    sampler = {"input": build.accessor([[0], [1]]), "output": build.accessor(np.ones((2, 3)))}
    build.json |= {
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_variants", "VENDOR_unknown"],
        "extensions": {
            "KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 543.5141306588226}]},
            "VENDOR_unknown": {"blob": {"bufferView": build.view(b"of a vendor")}, "text": "ä #1"},
        },
        "images": [{"bufferView": build.view(PICTURE), "mimeType": "image/png"}],
        "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}}}, {"name": "second"}],
        "meshes": [
            {
                "name": "sheet",
                "extras": {"targetNames": ["moved"]},
                "weights": [0.25],
                "primitives": [*parts, {"attributes": {"POSITION": lines}, "mode": 1}],
            },
            {"primitives": [strips[0]]},
            {"name": "fan", "primitives": [rays]},
            {"name": "again", "primitives": [again]},
            {"name": "strip", "primitives": [strips[1]]},
        ],
        "skins": [{"joints": [1, 2], "inverseBindMatrices": build.accessor(np.tile(np.eye(4).ravel(), (2, 1)))}],
        "nodes": [
            {"mesh": 0, "skin": 0, "scale": [2, 2, 2]},
            {"name": "a"},
            {"name": "b"},
            {"children": [4], "scale": [2, 2, 2]},
            {"mesh": 1, "matrix": [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 5, 5, 1]},
            *({"mesh": mesh} for mesh in (2, 1, 3)),
            {"mesh": 4, "scale": [-8, 1, 1]},
            {"camera": 0},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}},
        ],
        "scenes": [{"nodes": [0, 1, 2, 3, *range(5, 11)]}],
        "scene": 0,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "animations": [
            {"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}], "samplers": [sampler]}
        ],
    }
    build.json["buffers"] = [{"byteLength": len(build.buffer), "extras": "mine"}]
    return build


def save(path, build, how="glb"):
    document = copy.deepcopy(build.json)
    if how == "glb":
        text = json.dumps(document, ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        data = build.buffer + bytes(-len(build.buffer) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
        chunks += struct.pack("<I4s", 4, b"MINE") + b"keep"
        path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks)
        return path
    if how == "embedded":
        document["buffers"][0]["uri"] = (
            "data:application/octet-stream;base64," + base64.b64encode(build.buffer).decode()
        )
    else:
        document["buffers"][0]["uri"] = "my%20data.bin"
        (path.parent / "my data.bin").write_bytes(build.buffer)
    path.write_text(json.dumps(document, indent=2, ensure_ascii=False), encoding="utf-8")
    return path


def load(path):
    """Return the document, its buffers and all other chunks."""
    data = path.read_bytes()
    if data[:4] != b"glTF":
        document = json.loads(data)
        buffers = []
        for buffer in document["buffers"]:
            uri = buffer["uri"]
            is_data = uri.startswith("data:")
            buffers.append(
                base64.b64decode(uri.split(",")[1]) if is_data else (path.parent / uri.replace("%20", " ")).read_bytes()
            )
        return document, buffers, []
    assert struct.unpack_from("<II", data, 4) == (2, len(data))
    chunks, at = [], 12
    while at < len(data):
        length, kind = struct.unpack_from("<I4s", data, at)
        assert length % 4 == 0
        chunks.append((kind, data[at + 8 : at + 8 + length]))
        at += 8 + length
    return json.loads(chunks[0][1]), [chunks[1][1]], chunks[2:]


def values(document, buffers, number):
    """Read an accessor value by value."""
    accessor = document["accessors"][number]
    kind = next(name for name, code in COMPONENTS.items() if code == accessor["componentType"])
    width = next(w for w, name in WIDTHS.items() if name == accessor["type"])

    def read(place, count, kind, width):
        view = document["bufferViews"][place["bufferView"]]
        size = np.dtype(kind).itemsize
        start = view.get("byteOffset", 0) + place.get("byteOffset", 0)
        stride = view.get("byteStride", size * width)
        assert (
            start % size == 0 and place.get("byteOffset", 0) + stride * (count - 1) + size * width <= view["byteLength"]
        )
        rows = [buffers[view["buffer"]][start + k * stride :][: size * width] for k in range(count)]
        return np.array([np.frombuffer(row, "<" + kind) for row in rows])

    found = (
        read(accessor, accessor["count"], kind, width)
        if "bufferView" in accessor
        else np.zeros((accessor["count"], width))
    )
    if sparse := accessor.get("sparse"):
        index = next(name for name, code in COMPONENTS.items() if code == sparse["indices"]["componentType"])
        found[read(sparse["indices"], sparse["count"], index, 1).ravel()] = read(
            sparse["values"], sparse["count"], kind, width
        )
    if "min" in accessor:
        assert np.allclose(found.min(0), accessor["min"]) and np.allclose(found.max(0), accessor["max"])
    return found


def corners_of(document, buffers, primitive):
    """Return the rows of the corners of a primitive, triangle by triangle, or of its points and lines."""
    count = document["accessors"][primitive["attributes"]["POSITION"]]["count"]
    rows = (
        values(document, buffers, primitive["indices"]).ravel().astype(int)
        if "indices" in primitive
        else np.arange(count)
    )
    mode = primitive.get("mode", 4)
    if mode == 5:
        turned = [(a, b, c) if k % 2 == 0 else (a, c, b) for k, (a, b, c) in enumerate(zip(rows, rows[1:], rows[2:]))]
        return np.array(turned).ravel()
    if mode == 6:
        return np.array([(b, c, rows[0]) for b, c in itertools.pairwise(rows[1:])]).ravel()
    return rows


def meaning(path, without="TEXCOORD_0"):
    """Return a file's content except one UV set: with indices resolved, and corners without vertices."""
    document, buffers, others = load(path)
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            rows = corners_of(document, buffers, primitive)
            is_kept = primitive.get("mode", 4) < 4
            for each in [primitive["attributes"], *primitive.get("targets", [])]:
                for name, number in each.items():
                    about = document["accessors"][number]
                    told = [
                        about["componentType"],
                        about["type"],
                        about.get("normalized"),
                        about.get("name"),
                        about.get("extras"),
                    ]
                    each[name] = [*told, values(document, buffers, number)[rows].tolist()]
                each.pop(without, None)
            primitive.pop("indices", None)
            if not is_kept:
                primitive.pop("mode", None)
    for skin in document.get("skins", []):
        skin["inverseBindMatrices"] = values(document, buffers, skin["inverseBindMatrices"]).tolist()
    for animation in document.get("animations", []):
        for sampler in animation["samplers"]:
            for key in ("input", "output"):
                sampler[key] = values(document, buffers, sampler[key]).tolist()

    def resolved(part):
        if isinstance(part, dict):
            return {k: view_bytes(v) if k == "bufferView" else resolved(v) for k, v in part.items()}
        return [resolved(each) for each in part] if isinstance(part, list) else part

    def view_bytes(number):
        view = document["bufferViews"][number]
        start = view.get("byteOffset", 0)
        return buffers[view["buffer"]][start : start + view["byteLength"]]

    sizes = [len(buffer) for buffer in buffers]
    assert all(
        description.pop("byteLength") in (size, size - 1, size - 2, size - 3)
        for description, size in zip(document["buffers"], sizes)
    )
    for buffer in document["buffers"]:
        buffer.pop("uri", None)
    return {k: resolved(v) for k, v in document.items() if k not in ("accessors", "bufferViews")}, others


def seams_and_uv(asset):
    """Return for each mesh a map that is torn between some of its faces."""
    rng, result = np.random.default_rng(5), []
    for mesh in asset.meshes:
        uv = mesh.vertices[mesh.corner_vertices][:, :2] / 16
        uv[: len(uv) // 2] += 0.25
        uv[-3:] = rng.random((3, 2))
        result.append(assets.UvMap(uv.astype("f4").astype(float), np.ones(len(mesh.face_offsets) - 1, bool)))
    return result


@pytest.mark.parametrize("how", ["glb", "embedded", "beside"])
def test_all_else_is_as_it_was(how, tmp_path):
    path = save(tmp_path / f"m.{'glb' if how == 'glb' else 'gltf'}", everything(), how)
    asset = assets.read(path)
    assert [mesh.name for mesh in asset.meshes] == ["sheet", "mesh 1", "fan", "again", "strip"]
    assert [len(mesh.vertices) for mesh in asset.meshes] == [25, 6, 5, 25, 6]
    # A skinned mesh is moved by its joints alone.
    assert [mesh.scale for mesh in asset.meshes] == pytest.approx([1, 4, 1, 1, 2])
    assert asset.meshes[0].material_of_face.tolist() == [0] * 16 + [1] * 16
    assert [mesh.material_of_face for mesh in asset.meshes[1:]] == [None] * 4
    maps = seams_and_uv(asset)
    new = tmp_path / f"new{asset.suffix}"
    assets.write(new, asset, maps)
    assert meaning(new) == meaning(path)
    for mesh, uv_map in zip(assets.read(new).meshes, maps):
        assert np.abs(mesh.corner_uv - uv_map.uv).max() < 1e-6
    # What nothing uses any more is gone: another map needs as many bytes.
    again = tmp_path / f"again{asset.suffix}"
    assets.write(again, assets.read(new), maps)
    assert len(load(again)[1][0]) == len(load(new)[1][0])
    assert meaning(again) == meaning(path)
    if how == "beside":
        assert (tmp_path / "my data.bin").read_bytes() == everything().buffer


def test_new_data_has_the_order_of_the_attributes(tmp_path):
    """Not that of a set of their names, which differs from run to run."""
    asset = assets.read(save(tmp_path / "m.glb", everything()))
    assets.write(tmp_path / "n.glb", asset, seams_and_uv(asset))
    document, *_ = load(tmp_path / "n.glb")
    attributes = document["meshes"][0]["primitives"][0]["attributes"]
    views = [document["accessors"][number]["bufferView"] for name, number in attributes.items() if name != "TEXCOORD_0"]
    assert len(views) > 5
    assert views == sorted(views)


def with_normal_texture(number):
    """A sphere's part with normals and tangents, and a texture of normals."""
    build = Builder()
    places, triangles = grid(6)
    places[:, 2] = np.sqrt(1000 - ((places[:, :2] - 3) ** 2).sum(axis=1))
    normals = places - (3, 3, 0)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    attributes = {
        "POSITION": build.accessor(places), "NORMAL": build.accessor(normals),
        "TANGENT": build.accessor(np.tile([1, 0, 0, 1], (len(places), 1))), "TEXCOORD_0": build.accessor(places[:, :2]),
    }  # fmt: skip
    indices = build.accessor(triangles.reshape(-1, 1), "u2")
    build.json |= {
        "images": [{"bufferView": build.view(PICTURE), "mimeType": "image/png"}],
        "textures": [{"source": 0}],
        "materials": [{"normalTexture": {"index": 0, "texCoord": number}}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        "nodes": [{"mesh": 0}],
        "buffers": [{"byteLength": len(build.buffer)}],
    }
    return build


def test_tangents_are_those_of_the_map_that_their_texture_uses(tmp_path):
    for number in (0, 1):
        path = save(tmp_path / "m.glb", with_normal_texture(number))
        asset = assets.read(path)
        (mesh,) = asset.meshes
        # u grows with y, v against x; the second half is mirrored, and apart.
        uv = mesh.vertices[mesh.corner_vertices][:, [1, 0]] * (0.1, -0.1)
        mirrored = np.arange(len(uv)) >= 3 * (len(uv) // 6)
        uv[mirrored] = uv[mirrored] * (-1, 1) + 3
        assets.write(tmp_path / "new.glb", asset, [assets.UvMap(uv, np.ones(len(uv) // 3, bool))])
        said = ["The tangents of the replaced map were recomputed.", UNREAD]
        assert asset.warnings == [said[number]]
        document, buffers, _ = load(tmp_path / "new.glb")
        (primitive,) = document["meshes"][0]["primitives"]
        rows = corners_of(document, buffers, primitive)
        tangents, normals = (
            values(document, buffers, primitive["attributes"][name])[rows] for name in ("TANGENT", "NORMAL")
        )
        if number == 1:
            assert (tangents == [1, 0, 0, 1]).all()
            continue
        expected = np.where(mirrored[:, None], -1, 1) * [0, 1, 0] - 0 * normals
        expected -= normals * (expected * normals).sum(axis=1)[:, None]
        expected /= np.linalg.norm(expected, axis=1)[:, None]
        # Triangles on one side of a vertex: two degrees.
        assert (expected * tangents[:, :3]).sum(axis=1).min() > np.cos(np.radians(2))
        assert np.abs((normals * tangents[:, :3]).sum(axis=1)).max() < 1e-6
        # v grows against x, where y to the right has it: the normal times the tangent.
        assert (tangents[:, 3] == np.where(mirrored, -1, 1)).all()


def test_tangents_of_morph_targets_are_those_of_the_new_map(tmp_path):
    """A target that leans the sheet: its tangents and those at rest are those of a file with the leaning sheet."""
    build = with_normal_texture(0)
    (primitive,) = build.json["meshes"][0]["primitives"]
    places = values(build.json, [build.buffer], 0)
    normals = values(build.json, [build.buffer], 1)
    leaning = places + np.c_[0 * places[:, :2], places[:, 0]].astype("f4")
    turned = normals - np.c_[normals[:, 2], 0 * normals[:, 1:]].astype("f4")
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    changes = {"POSITION": leaning - places, "NORMAL": turned - normals, "TANGENT": np.ones_like(places)}
    primitive["targets"] = [{name: build.accessor(each) for name, each in changes.items()}]
    build.json["buffers"] = [{"byteLength": len(build.buffer)}]
    other = with_normal_texture(0)
    attributes = other.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["POSITION"], attributes["NORMAL"] = other.accessor(leaning), other.accessor(turned)
    other.json["buffers"] = [{"byteLength": len(other.buffer)}]
    found = []
    for each in (build, other):
        asset = assets.read(save(tmp_path / "m.glb", each))
        (mesh,) = asset.meshes
        uv = mesh.vertices[mesh.corner_vertices][:, [1, 0]] * (0.1, -0.1)
        assets.write(tmp_path / "n.glb", asset, [assets.UvMap(uv, np.ones(len(uv) // 3, bool))])
        document, buffers, _ = load(tmp_path / "n.glb")
        (new,) = document["meshes"][0]["primitives"]
        numbers = [new["attributes"]["TANGENT"], *(target["TANGENT"] for target in new.get("targets", []))]
        parts = [values(document, buffers, number)[:, :3] for number in numbers]
        found.append(sum(parts)[corners_of(document, buffers, new)])
    assert np.abs(found[0] - found[1]).max() < 1e-5


def broken(name):
    """Return the content of a file with one fault."""
    build = everything()
    document = build.json
    first = document["meshes"][0]["primitives"][0]
    if name == "index":
        document["accessors"][first["indices"]]["componentType"] = 5126
    elif name == "reaches beyond":
        document["accessors"][first["attributes"]["POSITION"]]["count"] = 10**6
    elif name == "no triangles":
        for mesh in document["meshes"]:
            for primitive in mesh["primitives"]:
                primitive["mode"] = 1
    elif name == "draco":
        first["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}}
    elif name == "meshopt":
        packed = {"buffer": 0, "byteLength": 16, "byteStride": 12, "mode": "ATTRIBUTES", "count": 25}
        document["bufferViews"][0]["extensions"] = {"EXT_meshopt_compression": packed}
    elif name == "accessor":
        first["attributes"]["POSITION"] = 999
    elif name == "two coordinates":
        document["accessors"][first["attributes"]["POSITION"]]["type"] = "VEC2"
    elif name == "not finite":
        build.buffer = np.full(len(build.buffer) // 4, np.nan, "f4").tobytes()
    return build


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("index", "indices are not unsigned integers"),
        ("reaches beyond", "bufferView 0 reaches beyond its buffer"),
        ("no triangles", "has no triangles"),
        ("draco", "geometry compressed by Draco is broken"),
        ("meshopt", "bufferView 0, compressed by meshopt, is broken: it begins with 00, not a0"),
        ("accessor", "structure is not that of glTF 2.0: IndexError"),
        ("two coordinates", "sheet has positions of 2 values, not of 3"),
        ("not finite", "the position of vertex 1 is not finite|there is an index"),
    ],
)
def test_a_broken_file_is_named(name, said, tmp_path):
    path = save(tmp_path / "m.glb", broken(name))
    with pytest.raises(assets.AssetError, match=f"m.glb.*({said})"):
        assets.read(path)


@pytest.mark.parametrize("how", ["texCoord", "override"])
def test_what_the_material_makes_of_the_map_is_the_new_map(how, tmp_path):
    """As gltfpack stores maps: integers, and their scale in the material."""
    build, (places, triangles) = Builder(), grid(2)
    sets = [build.accessor(np.round(4095 * places[:, :2] / 2), "u2", view=None) for _ in range(2)]
    change = {"scale": [1 / 4095, 1 / 4095], "offset": [0.25, 0.5]}
    info = {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": change}}
    if how == "override":
        info["texCoord"], change["texCoord"] = 0, 1
    attributes = {"POSITION": build.accessor(places), "TEXCOORD_0": sets[0], "TEXCOORD_1": sets[1]}
    primitive = {"attributes": attributes, "indices": build.accessor(triangles.reshape(-1, 1), "u2"), "material": 0}
    material = {"pbrMetallicRoughness": {"baseColorTexture": info}}
    build.json |= {"meshes": [{"primitives": [primitive]}], "nodes": [{"mesh": 0}], "materials": [material]}
    build.json["textures"] = [{}]
    build.json["buffers"] = [{"byteLength": len(build.buffer)}]
    asset = assets.read(save(tmp_path / "m.glb", build), "1")
    uv = asset.meshes[0].corner_uv * (1, -1) + (0, 1)
    assert np.abs(uv - places[triangles.ravel(), :2] / 2 - (0.25, 0.5)).max() < 1e-3
    new = np.random.default_rng(3).random((len(uv), 2))
    assets.write(tmp_path / "n.glb", asset, [assets.UvMap(new, np.ones(len(triangles), bool))])
    again = assets.read(tmp_path / "n.glb", "1")
    assert np.abs(again.meshes[0].corner_uv - new).max() < 1e-6
    assert again.json["materials"] == [material]
    stored = again.numbers(again.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"])
    assert np.ptp(stored, axis=0).min() > 2000
    # The other set has no such scale.
    assert assets.read(tmp_path / "m.glb", "0").meshes[0].corner_uv.max() > 1000


@pytest.mark.parametrize(("given", "said"), [("", [UNREAD]), ("0", []), ("1", [])])
def test_a_set_that_no_texture_reads_is_named(given, said, tmp_path):
    assert assets.read(save(tmp_path / "m.glb", with_normal_texture(1)), given).warnings == said
    assert assets.read(save(tmp_path / "m.glb", with_normal_texture(0))).warnings == []


def test_materials_that_read_another_set_are_named(tmp_path):
    build = sheet()
    (primitive,) = build.json["meshes"][0]["primitives"]
    primitive["material"] = 0
    build.json["meshes"][0]["primitives"].append({**primitive, "material": 1})
    textures = ({"index": 0}, {"index": 0, "texCoord": 2})
    build.json["materials"] = [{"name": "skin", "normalTexture": textures[0]}, {"occlusionTexture": textures[1]}]
    build.json["textures"] = [{}]
    path = save(tmp_path / "m.glb", build)
    said = "No texture of material 1 reads TEXCOORD_0, only TEXCOORD_2: name that as the UV map to show the new one."
    assert assets.read(path).warnings == [said]
    assert assets.read(path, "0").warnings == []


def test_a_file_that_is_cut_off_or_something_else_is_named(tmp_path):
    whole = save(tmp_path / "m.glb", everything()).read_bytes()
    for content, said in (
        (whole[:-100], "cut off"),
        (whole[:12], "not a binary glTF"),
        (b"glTF" + struct.pack("<II", 1, 20) + whole[12:], "is glTF 1.0, which cannot be read: convert it to glTF 2.0"),
        (b"glTF" + struct.pack("<II", 3, 20) + whole[12:], "not a binary glTF of version 2"),
        (b'{"asset": {"version": "1.0"}, "meshes": {"m": {"primitives": []}}}', "is glTF 1.0, which cannot be read"),
        (b"{", "is not JSON"),
        (b"{\xff\xfe", "is not JSON"),
        (b"[]", "begins with 'glTF'"),
        (bytes(99), "begins with 'glTF'"),
    ):
        path = tmp_path / "cut.glb"
        path.write_bytes(content)
        with pytest.raises(assets.AssetError, match=said):
            assets.read(path)
    path = tmp_path / "list.gltf"
    path.write_bytes(b"[]")
    with pytest.raises(assets.AssetError, match="is not glTF: its JSON must be an object"):
        assets.read(path)
    alone = save(tmp_path / "m.gltf", everything(), "beside")
    (tmp_path / "my data.bin").unlink()
    with pytest.raises(FileNotFoundError, match="my data.bin"):
        assets.read(alone)


def test_what_draco_has_compressed_is_mapped(tmp_path):
    draco = pytest.importorskip("DracoPy")
    build = Builder()
    places, triangles = grid(5)
    normals = np.tile([0, 0, 1.0], (len(places), 1))
    data = draco.encode(places, triangles.astype("u4"), quantization_bits=16, normals=normals, preserve_order=True)
    by_kind = {each["attribute_type"]: each["unique_id"] for each in draco.decode(data).attributes}
    kinds = {"POSITION": draco.AttributeType.POSITION, "NORMAL": draco.AttributeType.NORMAL}
    told = {"bufferView": build.view(data), "attributes": {name: by_kind[kind] for name, kind in kinds.items()}}
    build.json["accessors"] = [
        *({"componentType": 5126, "count": len(places), "type": "VEC3"} for _ in range(2)),
        {"componentType": 5123, "count": triangles.size, "type": "SCALAR"},
    ]
    name = "KHR_draco_mesh_compression"
    primitive = {"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "extensions": {name: told}}
    picture = build.view(PICTURE)
    build.json |= {
        "extensionsUsed": [name, "KHR_lights_punctual"],
        "extensionsRequired": [name],
        "images": [{"bufferView": picture, "mimeType": "image/png"}],
        "meshes": [{"primitives": [primitive]}],
        "buffers": [{"byteLength": len(build.buffer)}],
    }
    path, new = save(tmp_path / "m.glb", build), tmp_path / "new.glb"
    asset = assets.read(path)
    (mesh,) = asset.meshes
    assert asset.warnings == ["Geometry that was compressed by Draco is now uncompressed."]
    assert np.abs(mesh.vertices[mesh.corner_vertices] - places[triangles.ravel()]).max() < 1e-3
    maps = seams_and_uv(asset)
    assets.write(new, asset, maps)
    document, buffers, _ = load(new)
    assert document["extensionsUsed"] == ["KHR_lights_punctual"] and "extensionsRequired" not in document
    (written,) = document["meshes"][0]["primitives"]
    rows = corners_of(document, buffers, written)
    assert "extensions" not in written
    assert np.abs(values(document, buffers, written["attributes"]["NORMAL"])[rows] - [0, 0, 1]).max() < 1e-2
    assert np.abs(assets.read(new).meshes[0].corner_uv - maps[0].uv).max() < 1e-6
    view = document["bufferViews"][document["images"][0]["bufferView"]]
    assert buffers[0][view["byteOffset"] :][: view["byteLength"]] == PICTURE
    # The compressed bytes are gone.
    assert data[:20] not in buffers[0]


def test_the_documents_script_for_files_runs(tmp_path, monkeypatch):
    text = (Path(__file__).resolve().parents[2] / "docs" / "scripting.md").read_text(encoding="utf-8")
    (code,) = [code for code in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if "assets" in code]
    monkeypatch.chdir(tmp_path)
    save(tmp_path / "chair.glb", everything())
    exec(compile(code, "scripting.md", "exec"), {})
    meshes = assets.read(tmp_path / "chair_uv.glb").meshes
    assert all(np.isfinite(mesh.corner_uv).all() for mesh in meshes)
    assert meaning(tmp_path / "chair_uv.glb") == meaning(tmp_path / "chair.glb")


def two_buffers():
    """Positions in one buffer, indices in another."""
    build = Builder()
    places, triangles = grid(3)
    attributes = {"POSITION": build.accessor(places)}
    first = build.buffer
    build.buffer = b""
    indices = build.accessor(triangles.reshape(-1, 1), "u2")
    build.json["bufferViews"][1]["buffer"] = 1
    build.json["buffers"] = [
        {"byteLength": len(data), "uri": uri} for data, uri in ((build.buffer, "x.bin"), (first, "deep/own%20y.bin"))
    ]
    for view in build.json["bufferViews"]:
        view["buffer"] = 1 - view["buffer"]
    build.json["meshes"] = [{"primitives": [{"attributes": attributes, "indices": indices}]}]
    return build, {"x.bin": build.buffer, "deep/own y.bin": first}


def test_buffers_that_stay_go_along(tmp_path):
    build, buffers = two_buffers()
    (tmp_path / "deep").mkdir()
    for name, data in buffers.items():
        (tmp_path / name).write_bytes(data)
    (tmp_path / "m.gltf").write_text(json.dumps(build.json))
    asset = assets.read(tmp_path / "m.gltf")
    (tmp_path / "out").mkdir()
    # Without a seam no vertex has a copy.
    flat = [assets.UvMap(m.vertices[m.corner_vertices][:, :2] / 16, np.ones(18, bool)) for m in asset.meshes]
    assets.write(tmp_path / "out" / "m.gltf", asset, flat)
    assert (tmp_path / "out" / "deep" / "own y.bin").read_bytes() == buffers["deep/own y.bin"]
    assert assets.read(tmp_path / "out" / "m.gltf").meshes[0].corner_uv is not None
    assert not (tmp_path / "out" / "x.bin").exists()


def test_a_buffer_that_another_file_uses_is_left_alone(tmp_path):
    """Two levels of detail in one buffer, named after the first."""
    path = save(tmp_path / "a.gltf", everything(), "beside")
    (tmp_path / "my data.bin").rename(tmp_path / "a.bin")
    for name in ("a.gltf", "b.gltf"):
        (tmp_path / name).write_text(path.read_text(encoding="utf-8").replace("my%20data.bin", "a.bin"))
    shared, other = (tmp_path / "a.bin").read_bytes(), meaning(tmp_path / "b.gltf")
    for _ in range(2):
        asset = assets.read(path)
        assets.write(path, asset, seams_and_uv(asset))
        assert (tmp_path / "a.bin").read_bytes() == shared and meaning(tmp_path / "b.gltf") == other
    assert sorted(each.name for each in tmp_path.glob("*.bin")) == ["a.bin", "a_1.bin"]


def sheet(extension=None, document=None):
    """Four quads of triangles in a row with a map, and an extension of their primitive."""
    build = Builder()
    places = np.array([(x, y, 0) for x in range(5) for y in (0, 1)], "f4")
    first = 2 * np.arange(4)[:, None]
    triangles = np.concatenate([first + [0, 2, 3], first + [0, 3, 1]], axis=1).reshape(-1, 3)
    attributes = {"POSITION": build.accessor(places), "TEXCOORD_0": build.accessor(places[:, :2] / 5)}
    primitive = {"attributes": attributes, "indices": build.accessor(triangles.reshape(-1, 1), "u2")}
    if extension:
        primitive["extensions"] = extension
        build.json["extensionsUsed"] = list(extension)
    build.json |= {"meshes": [{"name": "m", "primitives": [primitive]}], "nodes": [{"mesh": 0}], **(document or {})}
    build.json["buffers"] = [{"byteLength": len(build.buffer)}]
    return build


def cut_between_quads(asset):
    """A map with a seam between the second and the third quad."""
    mesh = asset.meshes[0]
    points = mesh.vertices[mesh.corner_vertices]
    face = mesh.face_of_corner()
    middle = np.array([points[face == k, 0].mean() for k in range(face[-1] + 1)]) > 2
    return assets.UvMap(points[:, :2] / 10 + 0.5 * middle[face][:, None], np.ones(face[-1] + 1, bool))


def test_polygons_of_ngon_encoding_stay_whole(tmp_path):
    asset = assets.read(save(tmp_path / "m.glb", sheet({"FB_ngon_encoding": {}})))
    mesh = asset.meshes[0]
    assert np.diff(mesh.face_offsets).tolist() == [4, 4, 4, 4]
    assert mesh.vertices[mesh.corner_vertices][:4, :2].tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]
    assert np.allclose(mesh.corner_uv, mesh.vertices[mesh.corner_vertices][:, :2] / 5 * (1, -1) + (0, 1))
    uv_map = cut_between_quads(asset)
    assets.write(tmp_path / "n.glb", asset, [uv_map])
    again = assets.read(tmp_path / "n.glb").meshes[0]
    assert np.diff(again.face_offsets).tolist() == [4, 4, 4, 4]
    assert np.allclose(again.corner_uv, uv_map.uv, atol=1e-6)
    # Without the extension, the same file has triangles.
    assert len(assets.read(save(tmp_path / "t.glb", sheet())).meshes[0].face_offsets) == 9


DATA = {
    "morph targets": ({}, {}),
    "feature ids": ({"EXT_mesh_features": {"featureIds": [{"featureCount": 2, "texture": {"index": 0}}]}}, {}),
    "property textures": (
        {"EXT_structural_metadata": {"propertyTextures": [0]}},
        {"EXT_structural_metadata": {"propertyTextures": [{"class": "c", "properties": {"p": {"index": 0}}}]}},
    ),
}


@pytest.mark.parametrize("what", DATA)
def test_data_on_the_replaced_map_is_named(what, tmp_path):
    extension, schema = DATA[what]
    build = sheet(extension, {"extensions": schema, "textures": [{}]})
    if what == "morph targets":
        build.json["meshes"][0]["primitives"][0]["targets"] = [{"TEXCOORD_0": 1}]
    path = save(tmp_path / "m.glb", build)
    said = [f"m: {what} use TEXCOORD_0, whose new map they do not fit; write to another set."]
    assert assets.read(path).warnings == said
    assert assets.read(path, "1").warnings == []


def test_accessors_that_an_extension_names_stay(tmp_path):
    build = sheet({"VENDOR_lines": {"indices": 2, "on": {"positions": 0, "uv": 1}}})
    path = save(tmp_path / "m.glb", build)
    asset, before = assets.read(path), assets.read(path)
    assets.write(tmp_path / "n.glb", asset, [cut_between_quads(asset)])
    again = assets.read(tmp_path / "n.glb")
    for number in range(3):
        assert np.array_equal(again.array(number), before.array(number))
    assert asset.warnings == ["VENDOR_lines may name vertices by number, of which those at seams now have copies."]


def test_points_that_share_vertices_with_triangles_are_drawn_once(tmp_path):
    """Triangles get copies of vertices at seams; points without indices would show these."""
    build = sheet()
    (primitive,) = build.json["meshes"][0]["primitives"]
    build.json["meshes"][0]["primitives"].append({"attributes": primitive["attributes"], "mode": 0})
    asset = assets.read(save(tmp_path / "m.glb", build))
    assets.write(tmp_path / "n.glb", asset, [cut_between_quads(asset)])
    again = assets.read(tmp_path / "n.glb")
    numbers = [each["attributes"]["POSITION"] for each in again.json["meshes"][0]["primitives"]]
    assert [len(again.array(number)) for number in numbers] == [12, 10]


@pytest.mark.parametrize("what", ["variant", "animation"])
def test_what_else_changes_the_map_of_a_material_is_named(what, tmp_path):
    """What KHR_texture_transform does in a variant of the material, or when animated."""
    plain, scaled = ({"index": 0, "extensions": {"KHR_texture_transform": {"scale": [k, k]}}} for k in (1, 2))
    build = sheet({"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}})
    build.json |= {"textures": [{}], "materials": [{"normalTexture": plain}, {"normalTexture": scaled}]}
    said = "Textures of the map use different or rotating KHR_texture_transform, which was left."
    (primitive,) = build.json["meshes"][0]["primitives"]
    primitive["material"] = 0
    if what == "animation":
        del primitive["extensions"]
        pointer = "/materials/0/normalTexture/extensions/KHR_texture_transform/offset"
        target = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}
        samplers = [{"input": build.accessor([[0], [1]]), "output": build.accessor([[0, 0], [1, 0]])}]
        build.json["animations"] = [{"samplers": samplers, "channels": [{"sampler": 0, "target": target}]}]
        build.json["buffers"] = [{"byteLength": len(build.buffer)}]
        said = "Animations change KHR_texture_transform, of which the new map has the state without them."
    assert assets.read(save(tmp_path / "m.glb", build)).warnings == [said]


def test_a_required_extension_that_is_unknown_is_named(tmp_path):
    said = ["The file requires VENDOR_zip, which is unknown here and may hold or change geometry."]
    for name in ("VENDOR_zip", "KHR_texture_basisu"):
        path = save(tmp_path / "m.glb", sheet(document={"extensionsRequired": [name]}))
        assert assets.read(path).warnings == (said if name == "VENDOR_zip" else [])


def test_a_mesh_without_any_map_stays_as_it_is(tmp_path):
    asset = assets.read(save(tmp_path / "m.glb", sheet()))
    mesh = asset.meshes[0]
    none = assets.UvMap(np.zeros((len(mesh.corner_vertices), 2)), np.zeros(len(mesh.face_offsets) - 1, bool))
    assets.write(tmp_path / "n.glb", asset, [none])
    again = assets.read(tmp_path / "n.glb").meshes[0]
    assert np.array_equal(again.corner_uv, mesh.corner_uv)
    assert np.array_equal(again.corner_vertices, mesh.corner_vertices)
