"""A picture of seconds against vertices; needs matplotlib."""

from __future__ import annotations

import importlib.util
from collections.abc import Mapping, Sequence
from pathlib import Path


def is_possible() -> bool:
    """Return whether matplotlib is installed."""
    return importlib.util.find_spec("matplotlib") is not None


def seconds_against_vertices(path: Path, title: str, curves: Mapping[str, Sequence[tuple[int, float]]]) -> None:
    """Draw (vertices, seconds) curves, both axes logarithmic; the file's suffix says whether SVG, PNG or other."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    for (name, points), marker in zip(curves.items(), "os^Dvx"):
        axes.loglog(*zip(*points), label=name, marker=marker)
    axes.set(xlabel="vertices", ylabel="seconds", title=title)
    axes.grid(visible=True, which="major", alpha=0.4)
    axes.legend()
    figure.savefig(path)
    pyplot.close(figure)
