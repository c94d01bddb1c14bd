# SPDX-License-Identifier: GPL-3.0-or-later
"""Textured glTF files, and a renderer of its own that shows how they look."""

import base64
import io
import math
from urllib.parse import unquote

import numpy as np
import spectral_conformal as sc
from PIL import Image
from scipy import ndimage

from tests.module import meshes
from tests.module.test_gltf import Builder, corners_of, load, save, values

VIEWS = [(axis, sign) for axis in range(3) for sign in (1, -1)]
LIGHT = np.array([0.48, 0.6, 0.64])
TRANSFORM = "KHR_texture_transform"


# Images


def smooth(height, width, channels, seed, sigma=3.0):
    """(height, width, channels) bytes of a repeating pattern."""
    noise = np.random.default_rng(seed).normal(size=(height, width, channels))
    found = ndimage.gaussian_filter(noise, (sigma, sigma, 0), mode="wrap")
    found = (found - found.min(axis=(0, 1))) / np.ptp(found, axis=(0, 1))
    return np.rint(255 * found).astype(np.uint8)


def encoded(pixels, kind="PNG"):
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, kind, **({"quality": 95, "subsampling": 0} if kind == "JPEG" else {}))
    return file.getvalue()


# Meshes: positions, normals, UVs as glTF has them, triangles


TILES = np.array([3, 2])
INSET = 0.04


def sphere(n=10):
    """A cube of n x n quads to a side, made round; each side has a part of the texture."""
    places, quads = meshes.unit_square(n + 1)
    sides = range(6)
    normals = np.concatenate([on_side(np.full(len(places), side), places) for side in sides])
    corners = [np.array([side % TILES[0], side // TILES[0]]) for side in sides]
    uv = np.concatenate([(corner + INSET + (1 - 2 * INSET) * places) / TILES for corner in corners])
    return (
        normals.round(6),
        normals,
        uv,
        np.concatenate([side * len(places) + meshes.triangles_of(quads) for side in sides]),
    )


def on_side(side, places):
    """Return points of the unit sphere, (n, 3), at places (n, 2) of sides (n,) of a cube."""
    # As equal in size as angles.
    first, second = np.tan(np.pi / 4 * (2 * places - 1)).T
    axis, sign = side // 2, 1 - side % 2 * 2
    found = np.empty((len(places), 3))
    rows = np.arange(len(places))
    found[rows, axis], found[rows, (axis + 1) % 3], found[rows, (axis + 2) % 3] = sign, sign * first, second
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def painted(height, width, channels, seed, waves=40, frequency=9.0):
    """(height, width, channels) bytes of a texture of the sphere that is smooth across the sides of the cube."""
    side, places = _texels(height, width)
    rng = np.random.default_rng(seed)
    found = np.zeros((len(places), channels))
    for _ in range(waves):
        found += np.cos(on_side(side, places) @ rng.normal(size=(3, channels)) * frequency + 6 * rng.random(channels))
    found = np.clip(0.5 + 0.35 * found / (waves / 2) ** 0.5, 0, 1)
    return np.rint(255 * found).astype(np.uint8).reshape(height, width, channels)


def bumps(height, width, seed, frequency=9.0, dtype=np.uint8):
    """(height, width, 3) of a normal map of the sphere, likewise smooth; floats from -1 to 1."""
    side, places = _texels(height, width)
    points, rng = on_side(side, places), np.random.default_rng(seed)
    lean = np.zeros_like(points)
    for _ in range(20):
        direction = rng.normal(size=3)
        lean += 0.15 * direction * np.sin(frequency * points @ direction + 6 * rng.random())[:, None]
    along = _unit(on_side(side, places + (1e-4, 0)) - points)
    across = _unit(on_side(side, places - (0, 1e-4)) - points)
    across = np.sign((np.cross(points, along) * across).sum(axis=1, keepdims=True)) * np.cross(points, along)
    leaning = _unit(points + lean)
    found = np.stack([(leaning * each).sum(axis=1) for each in (along, across, points)], axis=1)
    found = found.reshape(height, width, 3)
    kind = np.dtype(dtype)
    return found.astype(kind) if kind.kind == "f" else np.rint(np.iinfo(kind).max * (found + 1) / 2).astype(kind)


def _texels(height, width):
    """Return the side of each texel, (n,), and its place there, (n, 2), which margins continue."""
    v, u = ((np.arange(n) + 0.5) / n for n in (height, width))
    at = np.stack(np.meshgrid(u, v), axis=2).reshape(-1, 2) * TILES
    corner = np.minimum(at.astype(int), TILES - 1)
    return corner[:, 0] + TILES[0] * corner[:, 1], (at - corner - INSET) / (1 - 2 * INSET)


def box(sides=3.0):
    """Every face shows the same repeated part of the texture."""
    corners, triangles, normals = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            first, second = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            normal = sign * np.eye(3)[axis]
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corners.append((*(0.5 * (normal + sign * (2 * u - 1) * first + (2 * v - 1) * second)), u, v))
            normals += [normal] * 4
            n = len(corners) - 4
            triangles += [(n, n + 1, n + 2), (n, n + 2, n + 3)]
    corners = np.array(corners)
    return corners[:, :3], np.array(normals), sides * corners[:, 3:], np.array(triangles)


# Files


class Textured:
    """A file with one mesh of one or several primitives, each with a material."""

    def __init__(self):
        self.build = Builder()
        self.build.json |= {
            "images": [],
            "textures": [],
            "samplers": [],
            "materials": [],
            "extensionsUsed": [TRANSFORM],
        }
        self.files = {}
        self.primitives = []

    def texture(self, content, uri=None, **sampler):
        kind = "image/png" if content.startswith(b"\x89PNG") else "image/jpeg"
        image = {"mimeType": kind, "name": f"picture {len(self.build.json['images'])}"}
        if uri == "data":
            image["uri"] = f"data:{kind};base64,{base64.b64encode(content).decode()}"
        elif uri:
            image["uri"] = uri
            self.files[unquote(uri)] = content
        else:
            image["bufferView"] = self.build.view(content)
        self.build.json["images"].append(image)
        self.build.json["samplers"].append(sampler)
        numbers = {"source": len(self.build.json["images"]) - 1, "sampler": len(self.build.json["samplers"]) - 1}
        self.build.json["textures"].append(numbers)
        return len(self.build.json["textures"]) - 1

    def material(self, **parts):
        self.build.json["materials"].append(parts)
        return len(self.build.json["materials"]) - 1

    def add(self, mesh, material, more_uv=(), with_tangents=False):
        positions, normals, uv, triangles = mesh
        attributes = {"POSITION": self.build.accessor(positions), "NORMAL": self.build.accessor(normals)}
        for k, each in enumerate((uv, *more_uv)):
            attributes[f"TEXCOORD_{k}"] = self.build.accessor(each)
        if with_tangents:
            attributes["TANGENT"] = self.build.accessor(sc.tangents(positions, triangles, uv * (1, -1), normals))
        indices = self.build.accessor(triangles.reshape(-1, 1), "u2")
        self.primitives.append({"attributes": attributes, "indices": indices, "material": material})

    def save(self, path, how="glb"):
        json = self.build.json
        json["meshes"] = [{"primitives": self.primitives}]
        json["nodes"], json["scenes"] = [{"mesh": 0}], [{"nodes": [0]}]
        json["buffers"] = [{"byteLength": len(self.build.buffer)}]
        for name, content in self.files.items():
            (path.parent / name).write_bytes(content)
        return save(path, self.build, how)


def moved(mesh, offset):
    return (mesh[0] + offset, *mesh[1:])


# Rendering


def render(path, size=160):
    """Return how a file looks from six sides, (6, size, size, 6) colors and data, and what is covered."""
    document, buffers, _ = load(path)
    parts = [_Primitive(path, document, buffers, each) for mesh in document["meshes"] for each in mesh["primitives"]]
    points = np.concatenate([part.positions for part in parts])
    low, high = points.min(axis=0), points.max(axis=0)
    scale = 0.98 * size / np.ptp(points, axis=0).max()
    pictures = np.zeros((len(VIEWS), size, size, 6))
    depths = np.full((len(VIEWS), size, size), -np.inf)
    for picture, depth, (axis, sign) in zip(pictures, depths, VIEWS):
        for part in parts:
            at = (part.positions - (low + high) / 2) * scale
            plane = np.c_[at[:, (axis + 1) % 3] * sign, at[:, (axis + 2) % 3]] + size / 2
            part.draw(picture, depth, plane, sign * at[:, axis])
    return pictures, np.isfinite(depths)


def _cross(one, other):
    return one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]


class _Primitive:
    def __init__(self, path, document, buffers, primitive):
        self.document = document
        self.path, self.buffers = path, buffers
        self.data = {key: values(document, buffers, number) for key, number in primitive["attributes"].items()}
        self.positions, self.normals = self.data["POSITION"].astype(float), self.data["NORMAL"].astype(float)
        self.triangles = corners_of(document, buffers, primitive).reshape(-1, 3)
        self.material = document["materials"][primitive["material"]]
        self.images = {}

    def draw(self, picture, depth, plane, height):
        size = len(depth)
        a, b, c = (plane[self.triangles[:, i]] for i in range(3))
        area = _cross(b - a, c - a)
        front = np.flatnonzero(area > 1e-12)
        corners = plane[self.triangles[front]]
        low = np.maximum(np.floor(corners.min(axis=1)), 0).astype(int)
        width, rows = np.maximum(np.minimum(np.ceil(corners.max(axis=1)), size).astype(int) - low, 0).T
        # Each triangle with each pixel of the rectangle around it.
        of = np.repeat(np.arange(len(front)), width * rows)
        step = np.arange(len(of)) - np.repeat(np.cumsum(width * rows) - width * rows, width * rows)
        x, y = low[of, 0] + step % width[of], low[of, 1] + step // width[of]
        k = front[of]
        out = np.stack([x, y], axis=1) + 0.5 - a[k]
        second, third = _cross(out, (c - a)[k]) / area[k], _cross((b - a)[k], out) / area[k]
        weights = np.stack([1 - second - third, second, third], axis=1)
        z = (weights * height[self.triangles[k]]).sum(axis=1)
        seen = np.flatnonzero((weights >= 0).all(axis=1) & (z > depth[y, x]))
        # The nearest at each pixel, of equals the first.
        seen = seen[np.lexsort((k[seen], -z[seen], size * y[seen] + x[seen]))]
        _, nearest = np.unique(size * y[seen] + x[seen], return_index=True)
        seen = seen[nearest]
        depth[y[seen], x[seen]] = z[seen]
        picture[y[seen], x[seen]] = self.shaded(self.triangles[k[seen]], weights[seen])

    def shaded(self, corners, weights):
        def between(values):
            return np.einsum("nk,nkd->nd", weights, values[corners].astype(float))

        normal = _unit(between(self.normals))
        surface = self.material.get("pbrMetallicRoughness", {})
        color = np.tile(np.array(surface.get("baseColorFactor", (1.0, 1.0, 1.0, 1.0))), (len(corners), 1))
        if "COLOR_0" in self.data:
            color[:, :3] *= between(self.data["COLOR_0"][:, :3])
        if base := surface.get("baseColorTexture"):
            color *= self.read(base, between, is_color=True)
        if bump := self.material.get("normalTexture"):
            value = 2 * self.read(bump, between)[:, :3] - 1
            frames = self.tangents(bump)
            # Without the vertices that triangles of both sides share.
            tangent = np.einsum("nk,nkd->nd", weights, frames(corners))
            side = np.sign(tangent[:, 3:])
            tangent = tangent[:, :3] - normal * (normal * tangent[:, :3]).sum(axis=1, keepdims=True)
            tangent = _unit(tangent)
            normal = _unit(
                value[:, :1] * tangent + side * value[:, 1:2] * np.cross(normal, tangent) + value[:, 2:] * normal
            )
        light = 0.25 + 0.75 * np.maximum((normal * LIGHT).sum(axis=1, keepdims=True), 0)
        shaded = color[:, :3] * light
        if glow := self.material.get("emissiveTexture"):
            shaded = np.minimum(shaded + 0.3 * self.read(glow, between, is_color=True)[:, :3], 1)
        if self.material.get("alphaMode") == "BLEND":
            shaded = shaded * color[:, 3:] + 0.2 * (1 - color[:, 3:])
        factors = 1.0, surface.get("roughnessFactor", 1.0), surface.get("metallicFactor", 1.0)
        data = np.tile(np.array(factors), (len(corners), 1))
        if rough := surface.get("metallicRoughnessTexture"):
            data *= self.read(rough, between)[:, :3]
        return 255 * np.c_[_code(shaded), data]

    def tangents(self, info):
        if "TANGENT" in self.data:
            return lambda corners: self.data["TANGENT"].astype(float)[corners]
        uv = self.uv(info) * (1, -1)
        points = uv[self.triangles]
        first, second = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
        is_mirrored = first[:, 0] * second[:, 1] < first[:, 1] * second[:, 0]
        both = [sc.tangents(self.positions, self.triangles[of], uv, self.normals) for of in (~is_mirrored, is_mirrored)]
        side = dict(zip(map(tuple, self.triangles.tolist()), is_mirrored.tolist()))

        def at(corners):
            own = np.array([side[tuple(each)] for each in corners.tolist()])
            return np.where(own[:, None, None], both[1][corners], both[0][corners])

        return at

    def uv(self, info):
        change = info.get("extensions", {}).get(TRANSFORM, {})
        uv = self.data[f"TEXCOORD_{change.get('texCoord', info.get('texCoord', 0))}"].astype(float)
        uv = uv * change.get("scale", (1, 1))
        cos, sin = math.cos(change.get("rotation", 0)), math.sin(change.get("rotation", 0))
        # Counterclockwise, with v downward: in the example of the extension, the lower left quadrant, turned by 90
        # degrees, has the offset (0, 1).
        return np.c_[cos * uv[:, 0] + sin * uv[:, 1], cos * uv[:, 1] - sin * uv[:, 0]] + change.get("offset", (0, 0))

    def read(self, info, between, is_color=False):
        """Return (n, 4) values, bilinearly; colors as light."""
        texture = self.document["textures"][info["index"]]
        if info["index"] not in self.images:
            image = self.document["images"][texture["source"]]
            pixels = np.asarray(Image.open(io.BytesIO(content_of(image, self))).convert("RGBA")) / 255.0
            self.images[info["index"]] = pixels
        pixels = self.images[info["index"]].copy()
        if is_color:
            pixels[:, :, :3] = _light(pixels[:, :, :3])
        sampler = self.document["samplers"][texture["sampler"]] if "sampler" in texture else {}
        height, width = pixels.shape[:2]
        uv = between(self.uv(info))
        x, y = uv[:, 0] * width - 0.5, uv[:, 1] * height - 0.5
        column, row = np.floor(x).astype(int), np.floor(y).astype(int)
        right, lower = (x - column)[:, None], (y - row)[:, None]
        found = 0
        for dx, dy in ((0, 0), (1, 0), (0, 1), (1, 1)):
            at = _wrapped(row + dy, height, sampler.get("wrapT")), _wrapped(column + dx, width, sampler.get("wrapS"))
            found = found + (right if dx else 1 - right) * (lower if dy else 1 - lower) * pixels[at]
        return found


def content_of(image, part):
    if "bufferView" in image:
        view = part.document["bufferViews"][image["bufferView"]]
        return part.buffers[0][view.get("byteOffset", 0) :][: view["byteLength"]]
    if image["uri"].startswith("data:"):
        return base64.b64decode(image["uri"].partition(",")[2])
    return (part.path.parent / unquote(image["uri"])).read_bytes()


def _wrapped(index, n, wrap):
    if wrap == 33071:
        return np.clip(index, 0, n - 1)
    if wrap == 33648:
        index = index % (2 * n)
        return np.where(index < n, index, 2 * n - 1 - index)
    return index % n


def _light(code):
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def _code(light):
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


def _unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12)
