# SPDX-License-Identifier: GPL-3.0-or-later
"""Every public function of the module, called while its arguments change."""

import itertools
import sys
import threading
from dataclasses import dataclass, field

import numpy as np
import spectral_conformal as sc

from tests.module import meshes

N = 12
EXTENDERS = ((0, 20, 0.01), (7, 100, -0.01))


@dataclass
class Arguments:
    """The arguments of all functions, in the types that need no conversion and could therefore be shared."""

    vertices: np.ndarray
    triangles: np.ndarray
    face_offsets: np.ndarray
    corner_vertices: np.ndarray
    seam_edges: np.ndarray
    selected_faces: np.ndarray
    pinned_corners: np.ndarray
    corner_uv: np.ndarray
    uv: np.ndarray
    vertex_preference: np.ndarray
    metric: np.ndarray
    triangle_metric: np.ndarray
    directions: np.ndarray
    ratios: np.ndarray
    sizes: np.ndarray
    front: np.ndarray
    image: np.ndarray
    normals: np.ndarray
    tangents: np.ndarray
    pins: dict = field(default_factory=dict)
    extenders: list = field(default_factory=list)
    changes: int = 0

    def arrays(self):
        return [value for value in vars(self).values() if isinstance(value, np.ndarray)]

    def change(self):
        """Change every argument in place, back and forth; a call may see a mixture of both."""
        self.changes += 1
        there = self.changes % 2 == 1
        for array in self.arrays():
            if array is self.face_offsets:
                # Of two quads a triangle and a pentagon.
                array[1:-1:2] += -1 if there else 1
            elif array.dtype == np.bool_:
                np.logical_not(array, out=array)
            elif array.dtype == np.int32:
                array[...] = array[::-1].copy()
            else:
                array[...] = array[::-1].copy() * (1.5 if there else 1 / 1.5)
        # Of another size each time, as an iteration would notice.
        self.pins.update({len(self.pins) % 20: (0.5, len(self.pins))})
        self.extenders[:] = [(1, 30, 0.01)] * (1 + len(self.extenders) % 7)


def some_arguments() -> Arguments:
    vertices, quads = meshes.saddle_quads(N)
    vertices = np.ascontiguousarray(vertices)
    offsets, corners = (np.ascontiguousarray(array, np.int32) for array in meshes.polygons(quads))
    triangles = meshes.triangles_of(quads).astype(np.int32)
    random = np.random.default_rng(0)
    selected = np.arange(len(quads)) % (N - 1) < N - 3
    pinned = np.zeros(len(corners), bool)
    pinned[[0, 2 * len(corners) // 3]] = True
    g = np.eye(3) + 0.1 * random.random((len(quads), 1, 1)) * np.ones((3, 3))
    h = np.eye(2) + 0.1 * random.random((len(triangles), 1, 1)) * np.ones((2, 2))
    return Arguments(
        vertices=vertices,
        triangles=triangles,
        face_offsets=offsets,
        corner_vertices=corners,
        seam_edges=np.array([[k, k + 1] for k in range(5 * N, 6 * N - 4)], np.int32),
        selected_faces=selected,
        pinned_corners=pinned,
        corner_uv=np.ascontiguousarray(vertices[corners][:, :2]),
        uv=np.ascontiguousarray(vertices[:, :2] * [1, 2]),
        vertex_preference=random.random(len(vertices)) * 0.5,
        metric=g,
        triangle_metric=h,
        directions=np.ascontiguousarray(random.normal(size=(len(triangles), 3))),
        ratios=1 + random.random(len(triangles)),
        sizes=random.random((30, 2)),
        front=np.array([0.0, -1.0, 0.0]),
        image=random.random((20, 30, 4), np.float32),
        normals=random.random((len(vertices), 3), np.float32),
        tangents=random.random((len(vertices), 4), np.float32),
        pins={0: (0.0, 0.0), 5: (1.0, 0.5)},
        extenders=list(EXTENDERS),
    )


def mesh(a):
    return a.vertices, a.face_offsets, a.corner_vertices


def cut(a):
    return {"seam_edges": a.seam_edges, "selected_faces": a.selected_faces}


def mapped(a):
    return meshes.mesh(*mesh(a), uv=a.corner_uv)


def with_pins(a):
    return {"pins": a.pins, "fixed": a.pinned_corners, "soft_pins": 1.0}


# Every public function that takes arrays. The arguments of an object also change before its first solve.
CALLS = {
    "parameterize": lambda a, p: sc.parameterize(
        a.vertices, a.triangles, extenders=a.extenders, metric=a.triangle_metric, progress=p
    ),
    "parameterize with pins": lambda a, p: sc.parameterize(a.vertices, a.triangles, pins=a.pins, progress=p),
    "parameterize with fixed": lambda a, p: sc.parameterize(
        a.vertices, a.triangles, fixed=a.triangles[0], uv=a.uv, progress=p
    ),
    "Solver": lambda a, p: sc.Solver(a.vertices, a.triangles, metric=a.triangle_metric, progress=p).solve(),
    "Solver.solve": lambda a, p: changed_after(
        sc.Solver(a.vertices, a.triangles, metric=a.triangle_metric), a, p
    ).solve(extenders=EXTENDERS, progress=p),
    "relax": lambda a, p: meshes.relax(a.vertices, a.triangles, a.uv, max_steps=3, progress=p),
    "pack": lambda a, p: meshes.pack(a.uv, a.face_offsets, a.corner_vertices, progress=p),
    "pattern": lambda a, _: sc.pattern(mapped(a)),
    "unwrap": lambda a, p: sc.unwrap(*mesh(a), **cut(a), extenders=a.extenders, metric=a.metric, progress=p),
    "unwrap with pins": lambda a, p: sc.unwrap(mapped(a), **cut(a), **with_pins(a), progress=p),
    "Unwrapper.solve": lambda a, p: changed_after(sc.Unwrapper(*mesh(a), **cut(a), metric=a.metric), a, p).solve(
        extenders=EXTENDERS, progress=p
    ),
    "Unwrapper.solve with moved pins": lambda a, p: sc.Unwrapper(mapped(a), **cut(a), **with_pins(a)).solve(
        uv=a.corner_uv, progress=p
    ),
    "Unwrapper with pins": lambda a, p: changed_after(sc.Unwrapper(mapped(a), **cut(a), **with_pins(a)), a, p).solve(
        progress=p
    ),
    "suggest_seams": lambda a, p: (
        sc.suggest_seams(
            *mesh(a), **cut(a), vertex_preference=a.vertex_preference, front=a.front, progress=p
        ).seam_edges
    ),
    "suggest_cuts": lambda a, p: sc.suggest_cuts(
        *mesh(a), **cut(a), vertex_preference=a.vertex_preference, max_length=20.0, progress=p
    ),
    "chart_of_face": lambda a, _: sc.hosts.chart_of_face(*mesh(a), **cut(a)),
    "distortion": lambda a, _: sc.distortion(a.vertices, a.triangles, a.uv),
    "face_distortion": lambda a, _: sc.face_distortion(mapped(a), selected_faces=a.selected_faces),
    "face_distortion of single precision": lambda a, _: sc.face_distortion(
        sc.Mesh(mesh(a)[0], mesh(a)[1], a.corner_uv.astype(np.float32), corner_vertices=mesh(a)[2]),
        selected_faces=a.selected_faces,
    ),
    "face_triangles": lambda a, _: sc.hosts.face_triangles(*mesh(a), selected_faces=a.selected_faces),
    "map_defects": lambda a, _: meshes.defects(
        a.face_offsets, a.corner_vertices, a.corner_uv, selected_faces=a.selected_faces, between_islands=True
    ),
    "metric_from_uv": lambda a, _: sc.metric_from_uv(a.vertices, a.triangles, a.uv),
    "metric_from_direction": lambda a, _: sc.metric_from_direction(a.vertices, a.triangles, a.directions, a.ratios),
    "blend_metric": lambda a, _: sc.blend_metric(a.triangle_metric, 0.5),
    "rebake": lambda a, p: sc.rebake(a.image, a.uv, a.uv, a.triangles, opacity=True, progress=p),
    "rebake normals": lambda a, p: sc.rebake(
        *(a.image, a.uv, a.uv, a.triangles),
        **{"content": "normals", "normals": a.normals, "old_tangents": a.tangents, "new_tangents": a.tangents},
        progress=p,
    ),
    "bake_values": lambda a, p: sc.bake_values(a.normals, a.uv, a.triangles, size=30, progress=p),
    "tangents": lambda a, _: sc.tangents(a.vertices, a.triangles, a.uv, a.normals),
    "pack_boxes": lambda a, _: sc.hosts.pack_boxes(a.sizes, quick=True),
}
WITH_PROGRESS = [name for name, call in CALLS.items() if "p" in call.__code__.co_varnames]
# Functions that call nothing compiled.
BY_NUMPY = {"tangents"}
# Functions without arrays.
WITHOUT_ARRAYS = {"build_info", "describe", "limit_threads", "message_templates"}


def changed_after(made, arguments, progress):
    """Return an object whose arguments were changed by a progress function, if there is one."""
    if progress is not None:
        progress(0.0, "")
    return made


def values(result):
    """Return the arrays and numbers of a result, except seconds, as a flat list."""
    if isinstance(result, np.ndarray):
        return [result]
    if isinstance(result, (list, tuple)):
        return list(itertools.chain.from_iterable(values(part) for part in result))
    if hasattr(result, "__dict__"):
        fields = {name: value for name, value in vars(result).items() if name != "timings"}
        if "charts" in fields:
            fields["charts"] = list(fields["charts"])
        return values(list(fields.values()))
    return [np.asarray(result)]


def assert_equal(found, expected):
    found, expected = values(found), values(expected)
    assert len(found) == len(expected)
    for mine, theirs in zip(found, expected):
        np.testing.assert_array_equal(mine, theirs)


def change_from_another_thread(name, calls):
    """Call a function while a thread changes all its arguments: it may refuse the mixture that it copied."""
    arguments = some_arguments()
    stop = threading.Event()

    def disturb():
        while not stop.is_set():
            arguments.change()

    thread = threading.Thread(target=disturb)
    thread.start()
    try:
        for _ in range(calls):
            try:
                CALLS[name](arguments, None)
            except (ValueError, sc.SolveError):
                continue
    finally:
        stop.set()
        thread.join()


def main():
    """Call the named functions, or all, this many times each: python -m tests.module.changing 20."""
    calls, *names = sys.argv[1:]
    for name in names or CALLS:
        change_from_another_thread(name, int(calls))
        print(name, flush=True)


if __name__ == "__main__":
    main()
