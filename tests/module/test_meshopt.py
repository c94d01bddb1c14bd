# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry compressed by meshopt: what the encoders of the reference library, meshoptimizer 0.2.30, made."""

import numpy as np
import pytest
from spectral_conformal import assets
from spectral_conformal.assets import meshopt

from tests.module import test_gltf

POSITIONS = (
    "a000000500300c03ffff8000c000008001003008007e00000700ffff8080ffffff8080ffffff8080ffffffc000ffff8080ffffff808005"
    "383e0f837e7f7e7f7e7fe0f800007e7f7e000005000f3cf0ffffffffffff003cc000ffffff05000eff7f7e7f7e7d807d807f003bc0007e"
    "7f7e0000000000000000000000000000000000000000000000000000000000000000"
)
TRIANGLES = (
    "e1fefefefefffffffffffffffffffffffffffffffefefefefeffffffffffffffffff0a021f021f021f02ff070a021f090c1f090c1f090c"
    "ff070a021f090c1f090c1f090cff070a021f090c1f090c1f090cff2f0c09ff000c09ff000c091f0cfa04f902f802f702f7070cf7090cf7"
    "090cf7090cf7070cf7090cf7090cf7090c007687566778a9866589689801690000"
)
INDICES = (
    "d10014041214041214041214040e14041214041214041214040e14041214041214041214040e14041214041214041214045e1812001812"
    "00181200181204181200181200181200181204181200181200181200181204181200181200181200181200000000"
)
# Restarted, far apart, and with vertices twice.
FAR = "e1f010ff40fe4ffffefffff80aed0a96fe0a0095fe0aff0202025f02ff020002007687566778a9866589689801690000"
OCTAHEDRAL = (
    "a0013f0000008aa027013f00000077b4c600013f0000000f0612000000000000000000000000000000000000000000000000000000007f"
    "007f05"
)
QUATERNION = (
    "a0013c0000008758013800000004013c000000c798011c00000008013c0000004211010c00000007013800000003000000000000000000"
    "00000000000000000000000000000000000000000000ff07"
)
EXPONENTIAL = (
    "a0013000000025011000000001100000000130000000060130000000090001300000002001300000002b00000000000000000000000000"
    "00000000000000000000000c0000fd05000002"
)


def sheet():
    """25 vertices, 32 triangles."""
    u, v = np.divmod(np.arange(25), 5)
    return np.c_[u, v, u * v % 3].astype("<f4"), test_gltf.grid(4)[1]


def decoded(text, mode, filter_name, count, stride, kind):
    return meshopt.decoded(bytes.fromhex(text), mode, filter_name, count, stride).view(kind).tolist()


def test_attributes_and_indices_are_those_that_were_encoded():
    places, triangles = sheet()
    assert decoded(POSITIONS, "ATTRIBUTES", "NONE", 25, 12, "<f4") == places.ravel().tolist()
    assert decoded(INDICES, "INDICES", "NONE", 96, 2, "<u2") == triangles.ravel().tolist()
    assert decoded(INDICES, "INDICES", "NONE", 96, 4, "<u4") == triangles.ravel().tolist()
    # Triangles may begin at another corner.
    found = np.reshape(decoded(TRIANGLES, "TRIANGLES", "NONE", 96, 4, "<u4"), (-1, 3))
    assert rolled(found) == rolled(triangles)
    far = [(0, 1, 2), (2, 1, 3), (700, 5, 90000), (3, 1, 4), (0, 1, 2), (4, 1, 5), (6, 7, 8), (9, 3, 2), (10, 10, 11)]
    assert rolled(np.reshape(decoded(FAR, "TRIANGLES", "NONE", 27, 4, "<u4"), (-1, 3))) == rolled(np.array(far))


def rolled(triangles):
    return [tuple(np.roll(row, -int(np.argmin(row))).tolist()) for row in triangles]


def test_filters_are_those_of_the_reference():
    unit = decoded(OCTAHEDRAL, "ATTRIBUTES", "OCTAHEDRAL", 4, 4, "i1")
    # The format allows one unit in the last place.
    assert np.abs(np.subtract(unit, [127, 0, 0, 5, -89, -89, 10, -3, 30, 45, 115, 0, 0, -127, 0, 9])).max() <= 1
    turned = decoded(QUATERNION, "ATTRIBUTES", "QUATERNION", 3, 8, "<i2")
    expected = [0, 0, 0, 32767, 374, 31772, 7923, -1132, 11319, -11319, 26255, 11319]
    assert np.abs(np.subtract(turned, expected)).max() <= 1
    assert decoded(EXPONENTIAL, "ATTRIBUTES", "EXPONENTIAL", 2, 8, "<f4") == [1.5, 20.0, -7.0, 1.0]


@pytest.mark.parametrize(
    ("text", "mode", "count", "stride"),
    [(POSITIONS, "ATTRIBUTES", 25, 12), (TRIANGLES, "TRIANGLES", 96, 4), (INDICES, "INDICES", 96, 4)],
)
def test_broken_data_is_named(text, mode, count, stride):
    data = bytes.fromhex(text)
    for broken in (data[:-40], data[:5], b"", b"\x00" + data[1:]):
        with pytest.raises((ValueError, IndexError)):
            meshopt.decoded(broken, mode, "NONE", count, stride)
    for size in ((count, 0), (count, 1000), (-1, stride)):
        with pytest.raises(ValueError, match="elements of"):
            meshopt.decoded(data, mode, "NONE", *size)


@pytest.mark.parametrize("form", ["glb", "gltf"])
@pytest.mark.parametrize("extension", ["EXT_meshopt_compression", "KHR_meshopt_compression"])
def test_a_compressed_file_is_written_uncompressed(form, extension, tmp_path):
    places, triangles = sheet()
    build = test_gltf.Builder()
    packed = [build.view(bytes.fromhex(text)) for text in (POSITIONS, TRIANGLES)]
    plain = build.view(b"a picture")
    views = build.json["bufferViews"]
    modes = (("ATTRIBUTES", 25, 12), ("TRIANGLES", 96, 2))
    for number, (mode, count, stride) in zip(packed, modes):
        own = {**views[number], "mode": mode, "count": count, "byteStride": stride}
        views[number] = {
            "buffer": 1,
            "byteOffset": 300 * number,
            "byteLength": count * stride,
            "extensions": {extension: own},
        }
    build.json["accessors"] = [
        {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 25},
        {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 96},
    ]
    build.json |= {
        "extensionsUsed": [extension],
        "extensionsRequired": [extension],
        "images": [{"bufferView": plain, "mimeType": "image/png"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"mesh": 0}],
        "buffers": [
            {"byteLength": len(build.buffer)},
            {"byteLength": 492, "extensions": {extension: {"fallback": True}}},
        ],
    }
    path = test_gltf.save(tmp_path / f"m.{form}", build, "glb" if form == "glb" else "embedded")
    asset = assets.read(path)
    mesh = asset.meshes[0]
    corners = mesh.vertices[mesh.corner_vertices].reshape(-1, 3, 3)
    assert {frozenset(map(tuple, each)) for each in corners.tolist()} == {
        frozenset(map(tuple, each)) for each in places[triangles].tolist()
    }
    new = assets.UvMap(corners.reshape(-1, 3)[:, :2] / 5, np.ones(32, bool))
    _, warnings = assets.write(tmp_path / f"n.{form}", asset, [new])
    assert warnings == ["Geometry that was compressed by meshopt is now uncompressed."]
    document, buffers, _ = test_gltf.load(tmp_path / f"n.{form}")
    assert extension not in str(document) and len(document["buffers"]) == 1
    image = document["bufferViews"][document["images"][0]["bufferView"]]
    assert bytes(buffers[0])[image["byteOffset"] :][: image["byteLength"]] == b"a picture"
    again = assets.read(tmp_path / f"n.{form}").meshes[0]
    assert np.array_equal(again.vertices, mesh.vertices) and np.allclose(again.corner_uv, new.uv, atol=1e-6)
