# SPDX-License-Identifier: GPL-3.0-or-later
"""Files with all possible content: what is read, and that writing UVs keeps every other byte."""

import bz2
import gzip
import lzma
import re
import struct
import sys
import tracemalloc
import warnings
from pathlib import Path

import numpy as np
import pytest
from spectral_conformal import assets

from tests.module import meshes
from tests.module.test_gltf import Builder
from tests.module.test_gltf import save as save_gltf

CASES = Path(__file__).resolve().parents[3] / "shared" / "cases" / "cli"
# Two quads side by side, with an idle vertex.
POSITIONS = [(0, 0, 0), (1, 0, 0), (1, 1, 0.2), (0, 1, 0), (2, 0, 0), (2, 1, 0), (9, 9, 9)]
QUADS = [(0, 1, 2, 3), (1, 4, 5, 2)]
# Of the corners: the quads share no UV, so that vertices 1 and 2 have two.
UV = np.array([(0, 0), (0.1, 0), (0.1, 1 / 3), (0, 0.4), (0.5, 0.5), (0.9, 0.5), (0.9, 0.9), (0.5, 0.9)])
VERTICES = "".join(f"v {x} {y} {z}\n" for x, y, z in POSITIONS)
BOTH = np.ones(2, bool)


def save(path, content):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def only(asset):
    (mesh,) = asset.meshes
    return mesh


def with_uv(path, uv=UV, mapped=BOTH):
    """Write UVs and return the content of the new file and what is read of it."""
    new = path.with_name(f"new{path.suffix}")
    assets.write(new, assets.read(path), [assets.UvMap(uv, mapped)])
    return new.read_bytes(), only(assets.read(new))


def check_mesh(mesh, uv=UV):
    assert mesh.vertices.tolist() == [list(map(float, row)) for row in POSITIONS]
    assert mesh.face_offsets.tolist() == [0, 4, 8]
    assert mesh.corner_vertices.tolist() == [*QUADS[0], *QUADS[1]]
    assert np.array_equal(mesh.corner_uv, uv, equal_nan=True)


# OBJ

OBJ = {
    "plain": VERTICES + "f 1 2 3 4\nf 2 5 6 3\n",
    "no end of line": VERTICES + "f 1 2 3 4\nf 2 5 6 3",
    "before its vertices": "f 1 2 3 4\nf 2 5 6 3\n" + VERTICES,
    "byte order mark": "\ufeff" + VERTICES + "f 1 2 3 4\nf 2 5 6 3\n",
    "CR LF": (VERTICES + "\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf 2//1 5//1 6//1 3//1\n").replace(
        "\n", "\r\n"
    ),
    "CR": (VERTICES + "f 1 2 3 4\nf 2 5 6 3\n").replace("\n", "\r"),
    "names with #": "mtllib scene #1.mtl\no Cube#3\n"
    + VERTICES
    + "usemtl Grey #1\nf 1 2 3 4\nusemtl M#25\nf 2 5 6 3\n",
    "Latin 1": b"mtllib w\xe4nde.mtl\no B\xfcro\n" + VERTICES.encode() + b"f 1 2 3 4\nf 2 5 6 3\n",
    "two blanks": VERTICES.replace("v ", "v  ") + "f  1  2  3\t4 \n  f 2 5 6 3\n",
    "continued": VERTICES + "f 1 2 \\\n 3 4 # four\n# no \\\nf 2 5 6\\\n   3\n",
    "colors": VERTICES.replace("\n", " 0.5 0.25 1\n") + "#MRGB ff00aa11\nf 1 2 3 4\nf 2 5 6 3\n",
    "comments": VERTICES.replace("\n", " # v\n") + "f 1 2 3 4 # f 1 2 3\nf 2 5 6 3 #\n",
    "relative": VERTICES + "vt 0 0\nvt 1 1\nf -7/-2 -6/-1 -5/1 -4/2\nf -6 -3 -2 -5\n",
    "tabs": VERTICES.replace("v ", "v\t") + "vt\t0\t0\nvn\t0 0 1\nf\t1/1/1\t2/1/1 3/1/1 4/1/1\n\tf\t2\t5\t6\t3\ng\tx\n",
    "faces of two": VERTICES + "f 1 2\nf 1 2 3 4\nf 7\nf 2 5 6 3\nf 5 6\n",
    "mixed": VERTICES + "vt 0\nvn 0 0 1\nf 1/1 2 3//1 4/1/1\nf 2/1/ 5 6 3\ns off\ng a b\nl 1 2\np 3\n",
    "UVs between": VERTICES
    + "vt 0 0\nf 1/1 2/1 3/1 4/1\nusemtl a\nvt 1 1\nf 2/2 5/2 6/2 3/2\ncstype bezier\ncurv 0 1 1 2\n",
}


# A statement with all the lines that it goes on in, but no comment.
STATEMENT = re.compile(rb"(?:#[^\r\n]*|(?:\\\n|[^\r\n])*)(?:\r?\n|\r)?")


def others(content):
    """Return the statements without UVs, and faces without theirs, as bytes."""
    found = [statement for statement in STATEMENT.findall(content) if statement.split()[:1] != [b"vt"]]
    without = re.compile(rb"(\d)/-?\d*(/-?\d+)?/?")
    return [without.sub(rb"\1\2", one) if one.split()[:1] == [b"f"] else one for one in found]


@pytest.mark.parametrize("name", OBJ)
def test_every_other_byte_of_an_obj_stays(name, tmp_path):
    path = save(tmp_path / "m.obj", OBJ[name])
    before = path.read_bytes()
    content, mesh = with_uv(path)
    check_mesh(mesh)
    assert others(content) == others(before)
    # Once more gives the same file.
    assert with_uv(save(tmp_path / "again.obj", content))[0] == content


# Faces of two corners or one among two quads, of which one has a map in the file or, by vertex, both.
ROWS = "4 0 1 2 3{}\n2 0 1{}\n4 1 4 5 2{}\n1 6{}\n"
POINTS = "".join(f"{x} {y} {z}\n" for x, y, z in POSITIONS)
SHORT = {
    "m.obj": (OBJ["faces of two"], "3 faces have fewer than three corners: no UVs for them."),
    "m.off": (f"OFF\n7 4 0\n{POINTS}" + ROWS.replace("{}", ""), "2 faces have fewer than three corners: left out."),
    "vertices.ply": (
        "ply\nformat ascii 1.0\nelement vertex 7\nproperty double x\nproperty double y\nproperty double z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n" + POINTS + ROWS.replace("{}", ""),
        "2 faces have fewer than three corners: no UVs for them.",
    ),
    "corners.ply": (
        "ply\nformat ascii 1.0\nelement vertex 7\nproperty double x\nproperty double y\nproperty double z\nelement "
        "face 4\nproperty list uchar int vertex_indices\nproperty list uchar double texcoord\nend_header\n"
        + POINTS
        + ROWS.format(" 8 0 0 1 0 1 1 0 1", " 0", " 0", " 2 .5 .5"),
        "2 faces have fewer than three corners: no UVs for them.",
    ),
}


@pytest.mark.parametrize("name", SHORT)
def test_faces_of_fewer_than_three_corners_are_no_obstacle(name, tmp_path):
    content, warning = SHORT[name]
    asset = assets.read(save(tmp_path / name, content))
    assert list(asset.warnings) == [warning]
    new = tmp_path / f"new{asset.suffix}"
    assert warning in assets.write(new, asset, [assets.UvMap(UV, BOTH)])[1]
    mesh = only(assets.read(new))
    assert np.array_equal(mesh.vertices[mesh.corner_vertices], np.array(POSITIONS, float)[np.concatenate(QUADS)])
    assert np.array_equal(mesh.corner_uv, UV)


@pytest.mark.parametrize("name", ["m.obj", "m.ply"])
def test_a_vertex_of_no_face_needs_no_position(name, tmp_path):
    header = "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float z\n"
    lists = "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    content = {
        "m.obj": VERTICES + "f 1 2 3 4\nf 2 5 6 3\n",
        "m.ply": header + lists + POINTS + "4 0 1 2 3\n4 1 4 5 2\n",
    }[name]
    text, mesh = with_uv(save(tmp_path / name, content.replace("9 9 9", "nan nan nan")))
    assert np.isfinite(mesh.vertices).all() and b"nan nan nan" in text
    with pytest.raises(assets.AssetError, match="position of vertex 2 is not finite"):
        assets.read(save(tmp_path / name, content.replace("1 0 0\n", "1 nan 0\n")))


def with_last_position(name, path, last, is_used):
    """Save two quads, the second of which may have a last vertex at a position of given bytes."""
    corners = [0, 1, 2, 3, 1, 4, 6 if is_used else 5, 2]
    places = np.array(POSITIONS, "<f4").tobytes()[:-12] + last
    if name == "m.ply":
        kinds = "".join(f"property float {axis}\n" for axis in "xyz")
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex 7\n{kinds}element face 2\n"
        head += "property list uchar int vertex_indices\nend_header\n"
        return save(path, head.encode() + places + struct.pack("<B4iB4i", 4, *corners[:4], 4, *corners[4:]))
    if name == "m.glb":
        build = Builder()
        n_rows = build.accessor(np.zeros((7, 3)))
        build.buffer = build.buffer[:-84] + places
        triangles = np.array(corners)[[0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7], None]
        primitive = {"attributes": {"POSITION": n_rows}, "indices": build.accessor(triangles, "u2")}
        build.json |= {"meshes": [{"primitives": [primitive]}], "nodes": [{"mesh": 0}]}
        build.json["buffers"] = [{"byteLength": len(build.buffer)}]
        return save_gltf(path, build)
    if name == "m.stl":
        rows = np.frombuffer(places, "V12")[np.array(corners)[[0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7]]].reshape(-1, 3)
        content = b"".join(bytes(12) + one.tobytes() + bytes(2) for one in rows)
        return save(path, bytes(80) + struct.pack("<I", 4) + content)
    from pxr import Usd, UsdGeom, Vt

    stage = Usd.Stage.CreateNew(str(path))
    mesh = UsdGeom.Mesh.Define(stage, "/m")
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.frombuffer(places, "<f4").reshape(-1, 3)))
    mesh.CreateFaceVertexCountsAttr([4, 4])
    mesh.CreateFaceVertexIndicesAttr(corners)
    stage.GetRootLayer().Save()
    return path


@pytest.mark.parametrize("name", ["m.ply", "m.glb", "m.usdc", "m.stl"])
def test_nans_that_signal_are_nans(name, tmp_path):
    if name == "m.usdc":
        pytest.importorskip("pxr")
    signaling = 3 * struct.pack("<I", 0x7FA00000)
    with warnings.catch_warnings():
        # NumPy's, of casts and sums.
        warnings.simplefilter("error")
        gap = assets.read(with_last_position(name, tmp_path / name, signaling, is_used=False))
        assert np.isfinite(only(gap).vertices).all()
        with pytest.raises(assets.AssetError, match=r"position of vertex \d is not finite"):
            assets.read(with_last_position(name, tmp_path / f"used {name}", signaling, is_used=True))


@pytest.mark.parametrize("name", ["m.ply", "m.off"])
@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("4 0 1 2 2.5", "there is no vertex 2.5; the file has 7"),
        ("4 0 1 2 nan", "there is no vertex nan"),
        ("4 0 1 2 1e30", r"there is no vertex 1e\+30"),
        ("4 0 1 2 123456789", "there is no vertex 123456789"),
        ("3.5 0 1 2 3", "face has a list of length 3.5"),
        ("-1 0 1 2 3", "face has a list of length -1"),
    ],
)
def test_indices_are_whole(name, row, said, tmp_path):
    header = "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float z\n"
    lists = "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    head = {"m.ply": header + lists, "m.off": "OFF\n7 2 0\n"}[name]
    with warnings.catch_warnings(), pytest.raises(assets.AssetError, match=said):
        warnings.simplefilter("error")
        assets.read(save(tmp_path / name, f"{head}{POINTS}4 1 4 5 2\n{row}\n"))


def test_faces_that_are_strips_are_named(tmp_path):
    header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    strips = "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2 -1\n"
    with pytest.raises(assets.AssetError, match="triangle strips") as found:
        assets.read(save(tmp_path / "m.ply", header + strips))
    assert not isinstance(found.value, assets.NoMeshError)


def test_line_elements_keep_their_uvs(tmp_path):
    """Before, among and behind the faces, counted from the first UV or back from the last."""
    uv = "".join(f"vt {k} {k}\n" for k in range(4))
    content = (
        VERTICES + "l 1 2\n" + uv + "l 1/2 2/-1\nf 1/1 2/2 3/3 4/4\nvt 8 8\nf 2/5 5/5 6/5 3/5\nvt 9 9\nl 5/5 6/-1 3/1\n"
    )
    new, mesh = with_uv(save(tmp_path / "m.obj", content))
    check_mesh(mesh)
    lines = new.decode().splitlines()
    coordinates = [line.split()[1:] for line in lines if line.startswith("vt")]
    named = [
        [coordinates[int(word.split("/")[1]) - 1][0] for word in line.split()[1:]]
        for line in lines
        if "l " in line and "/" in line
    ]
    # -1 of the first line is the fourth; what has moved is counted from the first.
    assert [line for line in lines if line.startswith("l")][:2] == ["l 1 2", "l 1/2 2/4"]
    assert named == [["1", "3"], ["8", "9", "0"]]


def test_materials_of_an_obj(tmp_path):
    path = tmp_path / "a.obj"
    faces = "f 1 2 3\nusemtl red 1 # no\nf 1 3 4\nusemtl\tblue\nf 2 5 6\nusemtl red 1 # no\nf 2 6 3\n"
    path.write_text(VERTICES + faces)
    assert assets.read(path).meshes[0].material_of_face.tolist() == [-1, 0, 1, 0]
    path.write_text(VERTICES + "usemtl red\nf 1 2 3\nf 1 3 4\n")
    assert assets.read(path).meshes[0].material_of_face is None
    path.write_text(VERTICES + "usemtl red\n")
    with pytest.raises(assets.AssetError):
        assets.read(path)


def test_uvs_that_no_line_has_are_said(tmp_path):
    path = save(tmp_path / "m.obj", VERTICES + "f 1/1 2/2 3/3 4/4\nf 2/2 5/5 6/6 3/3\n")
    asset = assets.read(path)
    assert asset.warnings == ["Faces name UVs, but the file had none."] and only(asset).corner_uv is None
    content, mesh = with_uv(path)
    check_mesh(mesh)


def test_faces_without_a_map_get_no_uvs(tmp_path):
    path = save(tmp_path / "m.obj", VERTICES + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf 2/1 5/1 6/1 3/1\n")
    content, mesh = with_uv(path, mapped=np.array([False, False]))
    assert mesh.corner_uv is None and b"vt" not in content
    assert content.splitlines()[-2:] == [b"f 1//1 2//1 3//1 4//1", b"f 2 5 6 3"]


def test_positions_and_uvs_to_the_last_digit(tmp_path):
    rng = np.random.default_rng(1)
    positions = (1e7 + rng.random((8, 3))).tolist() + (1e-5 * rng.random((8, 3))).tolist()
    rows = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in positions) + "f 1 2 3 4 5 6 7 8\nf 9 10 11 12 13 14 15 16\n"
    uv = rng.random((16, 2))
    for name in ("m.obj", "m.off"):
        if name == "m.off":
            rows = "OFF\n16 2 0\n" + "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in positions)
            rows += "8 0 1 2 3 4 5 6 7\n8 8 9 10 11 12 13 14 15\n"
        new = tmp_path / "new.obj"
        assets.write(new, assets.read(save(tmp_path / name, rows)), [assets.UvMap(uv, BOTH)])
        mesh = only(assets.read(new))
        assert mesh.vertices.tolist() == positions and mesh.corner_uv.tolist() == uv.tolist()


OTHER_KINDS = {
    "is compressed by gzip": gzip.compress(b"o a"),
    "is compressed by bzip2": bz2.compress(b"o a"),
    "is compressed by xz": lzma.compress(b"o a"),
    "is a ZIP archive": b"PK\x03\x04" + bytes(40),
    "is a pointer of Git LFS": b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n",
    "is a web page": b"<!DOCTYPE html>\n<html></html>\n",
}


@pytest.mark.parametrize("said", OTHER_KINDS)
@pytest.mark.parametrize("suffix", [".obj", ".ply", ".off", ".stl", ".glb", ".gltf", ".usda"])
def test_files_of_another_kind_are_named(tmp_path, suffix, said):
    """An OBJ file that is a pointer or a page has no faces, which others may lack rightly, and would be skipped."""
    path = tmp_path / f"m{suffix}"
    path.write_bytes(OTHER_KINDS[said])
    with pytest.raises(assets.AssetError, match=f"m{suffix}: {said}") as raised:
        assets.read(path)
    assert not isinstance(raised.value, assets.NoMeshError)


def stl_bytes(n_triangles, n_lost=0, announced=None):
    """Return a binary STL file whose last triangles were lost to zeros."""
    rows = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    count = n_triangles if announced is None else announced
    return bytes(80) + struct.pack("<I", count) + rows * (n_triangles - n_lost) + bytes(50) * n_lost


FACET = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
PLY_HEAD = "element vertex 7\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n"
PLY_HEAD += "property list uchar int vertex_indices\nend_header\n"
PLY_ROWS = np.array(POSITIONS, "<f4").tobytes() + struct.pack("<B4i", 4, 0, 1, 2, 3)
# A valid file and damaged ones, each with what is said of it.
DAMAGED = {
    "m.obj": (
        VERTICES + "f 1 2 3 4\nf 2 5 6 3",
        (VERTICES + "f 1 2 3 4\nf 2 5", "m.obj:9: ends within a face: the file is cut off"),
        (VERTICES + "f 1 2 3 4\n" + 12 * "\0", "m.obj:9: is text, but has bytes of zero"),
        (VERTICES.replace("9 9 9", "\0\0 9 9") + "f 1 2 3 4\n", "is text, but has bytes of zero"),
        (99 * "\0", "m.obj:1: is text, but has bytes of zero"),
        ((VERTICES + "f 1 2 3 4\n").encode("utf-16"), "is text in UTF-16, which cannot be read"),
    ),
    "m.off": (
        f"OFF\n7 1 0\n{POINTS}4 0 1 2 3\n\n# more\n",
        (f"OFF\n7 1 0\n{POINTS}4 0 1 2 3\n4 1 4 5 2\n", "9 bytes follow the rows that the header announces"),
        (f"OFF\n7 0 0\n{POINTS}4 0 1 2 3\n4 1 4 5 2\n", "19 bytes follow the rows that the header announces"),
        (f"OFF\n7 2 0\n{POINTS}4 0 1 2 3\n\0\0\0", "m.off:11: is text, but has bytes of zero"),
    ),
    "text.ply": (
        "ply\nformat ascii 1.0\n" + PLY_HEAD.format(1) + POINTS + "4 0 1 2 3 \n\n",
        ("ply\nformat ascii 1.0\n" + PLY_HEAD.format(1) + POINTS + "4 0 1 2 3\n4 1 4 5 2\n", "9 bytes follow the rows"),
        ("ply\nformat ascii 1.0\n" + PLY_HEAD.format(2) + POINTS + "4 0 1 2 3\n\0\0", ":18: is text, but has bytes of"),
    ),
    "binary.ply": (
        ("ply\nformat binary_little_endian 1.0\n" + PLY_HEAD.format(1)).encode() + PLY_ROWS + b"\n",
        # Each zero reads as a face without corners.
        (
            ("ply\nformat binary_little_endian 1.0\n" + PLY_HEAD.format(9)).encode() + PLY_ROWS + bytes(8 * 17),
            "128 bytes follow the rows that the header announces",
        ),
    ),
    "text.stl": (
        "solid a\n" + FACET + "end solid a",
        ("solid a\n" + FACET, "ends without 'endsolid': the file is cut off"),
        ("solid a\n" + FACET + 99 * "\0", "text.stl:9: is text, but has bytes of zero"),
    ),
    "binary.stl": (
        stl_bytes(2),
        (stl_bytes(2, n_lost=1), "triangle 2 consists of zeros"),
        (stl_bytes(2, n_lost=2, announced=0), "the header announces 0 triangles, but the file has 2"),
        (stl_bytes(9, announced=1), "the header announces 1 triangles, but the file has 9"),
        (bytes(199), "the header announces 0 triangles, but the file has 2"),
    ),
}


@pytest.mark.parametrize("name", DAMAGED)
def test_what_is_damaged_is_no_file_without_a_mesh(name, tmp_path):
    """Cut off, or with a part of zeros, as disks and downloads leave files: half a mesh is no result either."""
    whole, *damaged = DAMAGED[name]
    assert assets.read(save(tmp_path / name, whole)).meshes
    for content, said in damaged:
        with pytest.raises(assets.AssetError, match=said) as found:
            assets.read(save(tmp_path / name, content))
        assert not isinstance(found.value, assets.NoMeshError)


def test_a_message_is_short_whatever_it_quotes(tmp_path):
    row = 3000 * "\x01"
    with pytest.raises(assets.AssetError, match=r"m.off:3: '\\x01.* has a word that is not a number") as found:
        assets.read(save(tmp_path / "m.off", f"OFF\n3 1 0\n{row}\n"))
    assert len(str(found.value)) < 700


# PLY

TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "int": "i4", "uint": "u4", "float": "f4", "double": "f8"}
PLAIN = {"vertex": [("x", "float"), ("y", "float"), ("z", "float")], "face": [("vertex_indices", "uchar int")]}
RICH = {
    "vertex": [
        ("red", "uchar"),
        ("x", "double"),
        ("y", "double"),
        ("z", "double"),
        ("nx", "float"),
        ("quality", "short"),
    ],
    "edge": [("vertex1", "int"), ("vertex2", "int")],
    "face": [("label", "uint"), ("vertex_index", "uchar uchar"), ("flags", "int")],
    "material": [("weights", "int double")],
}
ON_VERTICES = {**PLAIN, "vertex": [("s", "double"), *PLAIN["vertex"], ("t", "float"), ("alpha", "uchar")]}
ON_CORNERS = {**PLAIN, "face": [("texcoord", "uchar float"), *PLAIN["face"], ("texnumber", "int")]}
LAYOUTS = {"plain": PLAIN, "rich": RICH, "on vertices": ON_VERTICES, "on corners": ON_CORNERS}


def values(element, name, row):
    """Return what a row of a made file has: numbers that tell row and property apart."""
    if name in ("x", "y", "z"):
        return [POSITIONS[row]["xyz".index(name)]]
    if name in ("vertex_indices", "vertex_index"):
        return QUADS[row]
    if name == "texcoord":
        return [0.25] * 8
    if name == "weights":
        return [0.1] * row
    return [row + len(name)]


def ply(layout, form, rows=None):
    """Return a PLY file, and of each element the rows as bytes; blanks and digits as other programs write them."""
    counts = {"vertex": 7, "face": 2, "edge": 1, "material": 2}
    order = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[form]
    header, body = f"ply\nformat {form} 1.0\ncomment TextureFile a.png\n", b""
    for element, properties in layout.items():
        header += f"element {element} {counts[element]}\n"
        for name, kind in properties:
            header += f"property {'list ' if ' ' in kind else ''}{kind} {name}\n"
        for row in range(counts[element]):
            parts = []
            for name, kind in properties:
                found = values(element, name, row)
                count, *last = [TYPES[word] for word in kind.split()]
                if order:
                    parts += [np.array(len(found), order + count).tobytes()] * len(last)
                    parts.append(np.array(found, order + (last or [count])[0]).tobytes())
                else:
                    parts += [b"%d" % len(found)] * len(last) + [b"%.2f" % n if n % 1 else b"%d" % n for n in found]
            body += b"".join(parts) if order else b"  ".join(parts) + b" \n"
    return header.encode() + b"end_header\n" + body


FORMS = pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])


def rows_of(content):
    """Read a PLY file plainly: the rows of each element as {name: numbers}, of text as they are written."""
    head, body = content.split(b"end_header\n", 1)
    words = [line.split() for line in head.decode().splitlines()]
    order = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[words[1][1]]
    text, result, at = iter(body.split()), {}, 0

    def take(count, kind):
        nonlocal at
        if not order:
            return [next(text).decode() for _ in range(count)]
        found = np.frombuffer(body, order + TYPES[kind], count, at)
        at += found.nbytes
        return found.tolist()

    elements = [k for k, line in enumerate(words) if line[0] == "element"]
    for first, last in zip(elements, [*elements[1:], len(words)]):
        rows = result[words[first][1]] = []
        for _ in range(int(words[first][2])):
            row = {}
            for line in words[first + 1 : last]:
                is_list = line[1] == "list"
                count = int(take(1, line[2])[0]) if is_list else 1
                row[line[-1]] = take(count, line[-2])
            rows.append(row)
    assert next(text, None) is None if not order else at == len(body)
    return result


def without(row, *names):
    return {name: found for name, found in row.items() if name not in names}


@FORMS
@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_other_property_of_a_ply_stays(layout, form, tmp_path):
    path = save(tmp_path / "m.ply", ply(LAYOUTS[layout], form))
    mesh = only(assets.read(path))
    expected = {
        "on vertices": np.array([(v + 1.0, v + 1.0) for quad in QUADS for v in quad]),
        "on corners": np.full((8, 2), 0.25),
    }
    assert np.allclose(mesh.vertices, POSITIONS)
    assert (mesh.corner_uv is None) == (layout not in expected)
    if layout in expected:
        assert mesh.corner_uv.tolist() == expected[layout].tolist()
    content, new = with_uv(path)
    assert np.abs(new.corner_uv - UV).max() < 1e-7
    assert new.vertices[new.corner_vertices].tolist() == mesh.vertices[mesh.corner_vertices].tolist()
    before, after = rows_of(path.read_bytes()), rows_of(content)
    assert before.keys() == after.keys()
    for element in before.keys() - {"vertex", "face"}:
        assert after[element] == before[element]
    (indices,) = {"vertex_index", "vertex_indices"} & set(before["face"][0])
    faces = zip(before["face"], after["face"])
    assert all(without(one, "texcoord", indices) == without(two, "texcoord", indices) for one, two in faces)
    if layout == "on corners":
        assert after["vertex"] == before["vertex"]
        assert [row[indices] for row in after["face"]] == [row[indices] for row in before["face"]]
        return
    # Two vertices have a second UV, and so a copy with all that they have.
    kept = [without(row, "s", "t") for row in after["vertex"]]
    assert kept == [without(before["vertex"][v], "s", "t") for v in (*range(7), 1, 2)]
    assert content.startswith(path.read_bytes().split(b"element vertex")[0])


@FORMS
def test_a_ply_gets_wider_lists_where_they_are_needed(form, tmp_path):
    """129 corners need 258 numbers, and more than 255 vertices; unsigned bytes hold 255."""
    n = 200
    angles = 2 * np.pi * np.arange(n) / n
    rows = np.c_[np.cos(angles), np.sin(angles), 0 * angles]
    uv = np.random.default_rng(2).random((2 * n, 2)).astype("f4")
    for face in ("property list uchar uchar vertex_indices", None):
        face = face or "property list uchar uchar vertex_indices\nproperty list uchar float texcoord"
        head = f"ply\nformat {form} 1.0\nelement vertex {n}\nproperty float x\nproperty float y\nproperty float z\n"
        content = (head + f"element face 2\n{face}\nend_header\n").encode()
        last = [0] if "texcoord" in face else []
        if form == "ascii":
            lines = [*rows.tolist(), *[[n, *range(n), *last]] * 2]
            content += "".join(" ".join(map(str, line)) + "\n" for line in lines).encode()
        else:
            order = ">" if "big" in form else "<"
            content += rows.astype(order + "f4").tobytes() + (bytes([n, *range(n)]) + bytes(last)) * 2
        new, mesh = with_uv(save(tmp_path / "m.ply", content), uv)
        assert np.array_equal(mesh.corner_uv.astype("f4"), uv)
        assert (b"list int float texcoord" if last else b"list uchar int vertex_indices") in new


@FORMS
@pytest.mark.parametrize("where", ["none", "vertex", "face"])
def test_uvs_of_a_ply_of_integers_are_floats(form, where, tmp_path):
    vertex = [(name, "short") for name in ("x", "y", "z")]
    layout = {"vertex": vertex, "face": PLAIN["face"]}
    if where == "vertex":
        layout["vertex"] = [("u", "uchar"), *vertex, ("v", "int")]
    elif where == "face":
        layout["face"] = [("texcoord", "uchar int"), *PLAIN["face"]]
    path = save(tmp_path / "m.ply", ply(layout, form))
    mesh = only(assets.read(path))
    content, new = with_uv(path)
    assert np.abs(new.corner_uv - UV).max() < 1e-7
    assert new.vertices[new.corner_vertices].tolist() == mesh.vertices[mesh.corner_vertices].tolist()
    assert content.count(b"property short") == 3


def test_a_ply_with_lengths_that_are_no_integers_is_named(tmp_path):
    content = ply({**PLAIN, "face": [("vertex_indices", "float int")]}, "ascii")
    with pytest.raises(assets.AssetError, match="'property list float int vertex_indices' is not a line of a PLY"):
        assets.read(save(tmp_path / "m.ply", content))


def test_uvs_of_a_ply_get_names_that_are_free(tmp_path):
    layout = {**PLAIN, "vertex": [("s", "uchar"), *PLAIN["vertex"]]}
    content, mesh = with_uv(save(tmp_path / "m.ply", ply(layout, "ascii")))
    assert np.abs(mesh.corner_uv - UV).max() < 1e-7
    assert [row["s"] for row in rows_of(content)["vertex"]] == [[str(v + 1)] for v in (*range(7), 1, 2)]
    with pytest.raises(assets.AssetError, match="'propertk uchar s' is not a line of a PLY header"):
        assets.read(save(tmp_path / "k.ply", ply(layout, "ascii").replace(b"property uchar s", b"propertk uchar s")))


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("m.obj", b"v 0 0 0\nv \x1d 1 0\n"),
        ("m.off", b"OFF\n1 0 0\n\x1d 1 0\n"),
        ("m.ply", b"ply\nformat ascii 1.0\n\x1d\nend_header\n"),
        ("m.stl", b"solid\nfacet normal 0 0 1\nouter loop\nvertex \x1d 1 0\n"),
    ],
)
def test_what_is_wrong_is_said_in_one_line_of_printable_characters(tmp_path, name, content):
    with pytest.raises(assets.AssetError) as found:
        assets.read(save(tmp_path / name, content))
    assert str(found.value).isprintable(), found.value


def test_a_ply_with_lines_of_windows(tmp_path):
    path = save(tmp_path / "m.ply", ply(PLAIN, "ascii").replace(b"\n", b"\r\n"))
    content, mesh = with_uv(path)
    assert np.abs(mesh.corner_uv - UV).max() < 1e-7
    assert content.count(b"\n") == content.count(b"\r\n")


def test_a_ply_that_begins_with_capitals(tmp_path):
    path = save(tmp_path / "m.ply", ply(PLAIN, "ascii").replace(b"ply", b"PLY", 1))
    content, mesh = with_uv(path)
    assert np.abs(mesh.corner_uv - UV).max() < 1e-7
    assert content.startswith(b"PLY\n") and assets.read(path).warnings == []


# Memory


def grid_file(path):
    """Write a grid of quads, or of triangles where a format has no others, with UVs where it can."""
    n = 130
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="ij"))
    points, first = np.c_[x, y, x * y], np.arange(n * n).reshape(n, n)[:-1, :-1].ravel()
    quads = np.c_[first, first + n, first + n + 1, first + 1]
    head = f"element vertex {n * n}\n" + "".join(f"property float {name}\n" for name in "xyzst")
    head += f"element face {len(quads)}\nproperty list uchar int vertex_indices\nend_header\n"
    texts = {
        ".obj": ("", "v {0!r} {1!r} {2!r}\nvt {0!r} {1!r}\n", "f {0}/{0} {1}/{1} {2}/{2} {3}/{3}\n", 1),
        ".off": (f"OFF {n * n} {len(quads)} 0\n", "{} {} {}\n", "4 {} {} {} {}\n", 0),
        ".ply": (f"ply\nformat ascii 1.0\n{head}", "{0} {1} {2} {0} {1}\n", "4 {} {} {} {}\n", 0),
    }
    if path.suffix == ".stl":
        stored = np.zeros(len(quads), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        stored["corners"] = points[quads[:, :3]]
        path.write_bytes(bytes(80) + struct.pack("<I", len(stored)) + stored.tobytes())
    elif path.suffix == ".glb":
        build, triangles = Builder(), meshes.triangles_of(quads)
        attributes = {"POSITION": build.accessor(points), "TEXCOORD_0": build.accessor(points[:, :2])}
        indices = build.accessor(triangles.reshape(-1, 1), "u4")
        build.json |= {
            "meshes": [{"primitives": [{"attributes": attributes, "indices": indices}]}],
            "nodes": [{"mesh": 0}],
            "scenes": [{"nodes": [0]}],
            "buffers": [{"byteLength": len(build.buffer)}],
        }
        save_gltf(path, build, "glb")
    elif path.name == "binary.ply":
        rows = np.zeros(len(quads), [("count", "u1"), ("corners", "<i4", 4)])
        rows["count"], rows["corners"] = 4, quads
        content = np.c_[points, points[:, :2]].astype("<f4").tobytes() + rows.tobytes()
        path.write_bytes(f"ply\nformat binary_little_endian 1.0\n{head}".encode() + content)
    else:
        begin, vertex, face, base = texts[path.suffix]
        rows = [vertex.format(*row) for row in points.tolist()]
        path.write_text(begin + "".join(rows) + "".join(face.format(*row) for row in (quads + base).tolist()))
    return path


@pytest.mark.parametrize("name", ["m.obj", "text.ply", "binary.ply", "m.off", "m.stl", "m.glb"])
def test_memory_beside_a_file_is_that_of_arrays(name, tmp_path):
    path = grid_file(tmp_path / name)
    tracemalloc.start()
    try:
        asset = assets.read(path)
        mesh = only(asset)
        # A seam in the middle.
        points = mesh.vertices[mesh.corner_vertices]
        middle = np.repeat(points[mesh.face_offsets[:-1], 0] > 0.5, np.diff(mesh.face_offsets))
        new = assets.UvMap(points[:, :2] + 2.0 * middle[:, None], np.ones(len(mesh.face_offsets) - 1, bool))
        assets.write(tmp_path / f"new{asset.suffix}", asset, [new])
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    # What is processed at once is a block of the file, however many faces it has: its rows take less than 4 MB. The
    # result is read back beside the source.
    allowed = 2 * (path.stat().st_size + 300 * len(new.mapped)) + (4 << 20)
    assert peak < allowed, (0.5 * peak - path.stat().st_size) / len(new.mapped)


# Others


def test_materials_that_go_along_find_their_textures(tmp_path):
    """Above the file's folder, where they stay, and in it."""
    for name in ("tex", "scene/mats", "scene/own", "out", "far/out"):
        (tmp_path / name).mkdir(parents=True)
    for name in ("tex/far off.png", "scene/own/near.png"):
        (tmp_path / name).write_bytes(b"no picture")
    material = "newmtl a\nmap_Kd ../../tex/far off.png\nbump -bm 2 ../own/near.png\nmap_Ks missing.png\n"
    (tmp_path / "scene" / "mats" / "a.mtl").write_text(material)
    path = save(tmp_path / "scene" / "m.obj", "mtllib mats/a.mtl\n" + OBJ["plain"])
    assets.write(tmp_path / "out" / "m.obj", assets.read(path), [assets.UvMap(UV, BOTH)])
    (tmp_path / "out" / "mats" / ".." / "own" / "near.png").resolve(strict=True)
    # As far from the texture as the source.
    assert (tmp_path / "out" / "mats" / "a.mtl").read_text() == material
    assets.write(tmp_path / "far" / "out" / "m.obj", assets.read(path), [assets.UvMap(UV, BOTH)])
    written = (tmp_path / "far" / "out" / "mats" / "a.mtl").read_text()
    assert written == material.replace("../../tex/", "../../../tex/")


@pytest.mark.parametrize("name", ["m.obj", "m.ply"])
def test_a_name_for_the_only_map_is_said_to_have_no_effect(name, tmp_path):
    path = save(tmp_path / name, OBJ["plain"] if name == "m.obj" else ply(PLAIN, "ascii"))
    maps, new = [assets.UvMap(UV, BOTH)], tmp_path / f"new{path.suffix}"
    assert assets.write(new, assets.read(path), maps)[1] == []
    _, (said,) = assets.write(new, assets.read(path, "Lightmap"), maps)
    assert said == f"{path.suffix} files have one UV map without a name: it was replaced, not added as Lightmap."


def test_textures_of_the_faces_of_a_ply_are_said_to_stay(tmp_path):
    head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    head += "element face 2\nproperty list uchar int vertex_indices\nproperty int texnumber\nend_header\n"
    for numbers, said in (
        ((0, 0), []),
        ((0, 3), ["The faces keep their 2 textures (texnumber), but the map has one tile"]),
    ):
        rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 {}\n3 0 2 3 {}\n".format(*numbers)
        warnings = assets.read(save(tmp_path / "m.ply", head + rows)).warnings
        assert [warning[: len(said[0])] for warning in warnings] == said


def test_counts_of_an_off_file_may_follow_at_once(tmp_path):
    rows = "7 2 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in POSITIONS) + "4 0 1 2 3\n4 1 4 5 2\n"
    for begin in ("OFF", "OFF\n", "off ", "COFF\n", "# made here\nOFF\n\n"):
        mesh = only(assets.read(save(tmp_path / "m.off", begin + rows)))
        assert mesh.vertices.tolist() == [list(map(float, row)) for row in POSITIONS]
        assert mesh.corner_vertices.tolist() == [*QUADS[0], *QUADS[1]]


OFF_ROWS = {
    "": "{x} {y} {z}",
    "4OFF": "{x2} {y2} {z2} 2",
    "NOFF": "{x} {y} {z} 0 0 1",
    "STOFF": "{x} {y} {z} {s} {t}",
    "STN4OFF": "{x2} {y2} {z2} 2 0 0 1 {s} {t}",
    "STCOFF": "{x} {y} {z} 1 0 0 1 {s} {t}",
}


@pytest.mark.parametrize("word", OFF_ROWS)
@pytest.mark.parametrize("between", ["\n", " "])
def test_vertices_of_an_off_file_are_as_its_first_word_says(word, between, tmp_path):
    """Homogeneous positions are divided, and texture coordinates are the map."""
    rows = [
        OFF_ROWS[word].format(x=x, y=y, z=z, x2=2 * x, y2=2 * y, z2=2 * z, s=k / 10, t=k / 20)
        for k, (x, y, z) in enumerate(POSITIONS)
    ]
    text = between.join([f"{word}\n7 2 7", *rows, "4 0 1 2 3", "4 1 4 5 2"])
    mesh = only(assets.read(save(tmp_path / "m.off", text + "\n")))
    assert mesh.vertices.tolist() == [list(map(float, row)) for row in POSITIONS]
    if word.startswith("ST"):
        assert mesh.corner_uv.tolist() == [[k / 10, k / 20] for k in mesh.corner_vertices]
    else:
        assert mesh.corner_uv is None


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("nOFF\n4\n1 1 0\n0 0 0 0\n1 0\n", "has vertices of any dimension"),
        ("OFF BINARY\n\0\0\0\1", "is a binary OFF file"),
        ("4OFF\n3 1 0\n0 0 0 1\n1 0 0 0\n0 1 0 1\n3 0 1 2\n", "the position of vertex 2 is not finite"),
    ],
)
def test_what_an_off_file_cannot_have_is_named(text, said, tmp_path):
    with pytest.raises(assets.AssetError, match=f"m.off: {said}"):
        assets.read(save(tmp_path / "m.off", text))


@pytest.mark.parametrize(
    "text",
    [
        "OFF\n7\n2\n7\n{}",
        "OFF 7 2 7\n{}",
        "OFF 7 2 7 {}",
    ],
)
@pytest.mark.parametrize("apart", ["\n", " ", "  \n\n"])
def test_rows_of_an_off_file_may_take_several_lines(text, apart, tmp_path):
    values = [*np.ravel(POSITIONS), 4, *QUADS[0], 4, *QUADS[1]]
    mesh = only(assets.read(save(tmp_path / "m.off", text.format(apart.join(map(str, values))))))
    assert mesh.vertices.tolist() == [list(map(float, row)) for row in POSITIONS]
    assert mesh.corner_vertices.tolist() == [*QUADS[0], *QUADS[1]]


def test_unknown_lines_in_the_header_of_a_ply_stay(tmp_path):
    path = save(tmp_path / "m.ply", ply(PLAIN, "ascii").replace(b"\n", b"\nunits mm\n", 1))
    asset = assets.read(path)
    new = tmp_path / "n.ply"
    (tmp_path / "n.ply").write_bytes(b"")
    said = ["'units mm' in the header is unknown, and was left."]
    mesh = only(asset)
    uv_map = assets.UvMap(np.zeros((len(mesh.corner_vertices), 2)), np.ones(len(mesh.face_offsets) - 1, bool))
    assert assets.write(new, asset, [uv_map])[1] == said and b"\nunits mm\n" in new.read_bytes()


@pytest.mark.parametrize("form", ["text", "binary", "binary that begins as text"])
def test_triangles_of_an_stl_share_vertices(form, tmp_path):
    triangles = np.array([[POSITIONS[v] for v in face] for face in [(0, 1, 2), (0, 2, 3), (1, 4, 5)]], "f4")
    if form == "text":
        rows = "".join(
            "facet normal 0 0 1\n outer loop\n"
            + "".join(f"  vertex {x} {y} {z}\n" for x, y, z in one)
            + " endloop\nendfacet\n"
            for one in triangles.tolist()
        )
        content = f"solid a\n{rows}endsolid a\n".encode()
    else:
        begin = b"solid " if "text" in form else b"made by"
        content = begin.ljust(80, b"\0") + struct.pack("<I", 3)
        content += b"".join(bytes(12) + one.astype("<f4").tobytes() + b"\1\2" for one in triangles)
    mesh = only(assets.read(save(tmp_path / "m.stl", content)))
    assert mesh.corner_vertices.tolist() == [0, 1, 2, 0, 2, 3, 1, 4, 5]
    assert np.array_equal(mesh.vertices[mesh.corner_vertices].reshape(3, 3, 3), triangles)


def test_nothing_is_replaced_by_what_cannot_be_read_again(tmp_path, monkeypatch):
    path = save(tmp_path / "m.obj", OBJ["plain"])
    asset = assets.read(path)
    monkeypatch.setattr(assets, "digest", lambda path: "of something else")
    with pytest.raises(OSError, match="cannot be read again"):
        assets.write(path, asset, [assets.UvMap(UV, BOTH)])
    monkeypatch.undo()
    assert path.read_text() == OBJ["plain"]
    assert [found.name for found in tmp_path.iterdir()] == ["m.obj"]


@pytest.mark.skipif(sys.platform == "win32", reason="links and permissions of other systems")
def test_a_link_and_permissions_stay(tmp_path):
    path, link = save(tmp_path / "m.obj", OBJ["plain"]), tmp_path / "link.obj"
    link.symlink_to("m.obj")
    path.chmod(0o640)
    assets.write(link, assets.read(link), [assets.UvMap(UV, BOTH)])
    assert link.is_symlink() and path.stat().st_mode & 0o777 == 0o640
    check_mesh(only(assets.read(path)))


@pytest.mark.skipif(not CASES.is_dir(), reason="the shared cases are not beside the project")
@pytest.mark.parametrize(
    "name", ["bomshift.obj", "hash.obj", "latin.obj", "linesx.obj", "wedge.obj", "wedge.ply", "modelnet.off"]
)
def test_cases_of_others(name, tmp_path):
    asset = assets.read(CASES / name)
    assert (only(asset).corner_uv is not None) == (name in ("linesx.obj", "wedge.obj", "wedge.ply"))
    new = tmp_path / f"new{asset.suffix}"
    assets.write(new, asset, [assets.UvMap(UV, BOTH)])
    assert np.abs(only(assets.read(new)).corner_uv - UV).max() < 1e-7
    if asset.suffix == ".obj" and name != "modelnet.off":
        assert others(new.read_bytes()) == others((CASES / name).read_bytes())
