# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged files: each is read and written again, or rejected with a reason."""

import collections

import numpy as np
from spectral_conformal import assets

from tests.module import test_assets, test_gltf

CASES = 800


def sources(folder):
    """Write files with everything that they may have."""
    yield test_gltf.save(folder / "m.glb", test_gltf.everything())
    yield test_gltf.save(folder / "m.gltf", test_gltf.everything(), "embedded")
    for number, content in enumerate(test_assets.OBJ.values()):
        yield test_assets.save(folder / f"{number}.obj", content)
    for number, layout in enumerate(test_assets.LAYOUTS.values()):
        for form in ("ascii", "binary_little_endian"):
            yield test_assets.save(folder / f"{number}{form}.ply", test_assets.ply(layout, form))


def damaged(content, rng):
    """Change, insert or take away a few bytes; digits become others, as most other bytes end the reading at once."""
    content = bytearray(content)
    for _ in range(rng.integers(1, 5)):
        place = int(rng.integers(len(content)))
        what = rng.integers(6)
        if what == 0:
            content[place] = rng.integers(256)
        elif what == 1:
            del content[place : place + int(rng.integers(1, 9))]
        elif what == 2:
            content[place:place] = bytes(rng.integers(0, 256, rng.integers(1, 5), dtype=np.uint8))
        else:
            digits = [k for k in range(place, min(place + 300, len(content))) if chr(content[k]).isdigit()]
            if digits:
                content[digits[0]] = ord("0") + int(rng.integers(10))
    return bytes(content)


def test_damaged_files_are_read_or_named(tmp_path):
    rng, files, outcomes = np.random.default_rng(7), list(sources(tmp_path)), collections.Counter()
    for _ in range(CASES):
        source = files[rng.integers(len(files))]
        path, new = tmp_path / f"damaged{source.suffix}", tmp_path / f"new{source.suffix}"
        path.write_bytes(damaged(source.read_bytes(), rng))
        try:
            asset = assets.read(path)
            maps = [
                assets.UvMap(np.zeros((len(mesh.corner_vertices), 2)), np.ones(len(mesh.face_offsets) - 1, bool))
                for mesh in asset.meshes
            ]
            assets.write(new, asset, maps)
            assert all((mesh.corner_uv == 0).all() for mesh in assets.read(new).meshes)
            outcomes["read"] += 1
        except (assets.AssetError, OSError) as error:
            assert len(str(error).splitlines()) == 1
            outcomes["named"] += 1
    assert min(outcomes["read"], outcomes["named"]) > CASES // 10, outcomes
