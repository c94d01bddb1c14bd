"""Write a pattern at 1:1, as SVG and DXF."""

from __future__ import annotations

import importlib.util
import io
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt

from .._pattern import Pattern

# In millimeters.
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "ft": 304.8}
# Layers of the DXF, classes of the SVG.
_OUTLINE, _ENDS, _NUMBERS = "OUTLINES", "SEAM_ENDS", "SEAM_NUMBERS"
# Height of numbers over the longer side of the pattern; numbers of short seams are smaller.
_HEIGHT = 1 / 60
_DIGIT_WIDTH = 0.6
_DXF_MILLIMETERS = 4
# For SVG, in millimeters.
_LINE = 0.1


@dataclass(frozen=True)
class _Number:
    """A seam's number beside one of its sides, in millimeters; `angle` in degrees, counterclockwise."""

    text: str
    center: npt.NDArray[np.float64]
    angle: float
    height: float


class _Sheet:
    """What both formats draw, in millimeters, with the lower left corner at 0."""

    def __init__(self, pattern: Pattern, millimeters: float) -> None:
        points = pattern.points * millimeters
        self._points = points - points.min(axis=0)
        self._pattern = pattern
        self.size = self._points.max(axis=0, initial=0.0)
        self._height = _HEIGHT * float(self.size.max())
        self._of_side = pattern.sides[:-1], pattern.sides[1:]
        self._ends = pattern.ends()

    def outlines(self) -> Iterator[npt.NDArray[np.float64]]:
        """Yield the points of each closed outline."""
        yield from np.split(self._points, self._pattern.outlines[1:-1])

    def seam_ends(self) -> Iterator[npt.NDArray[np.float64]]:
        """Yield short lines (2, 2) into the islands from where each side of a seam begins and ends."""
        for number, first, end in zip(self._pattern.seams.tolist(), *(each.tolist() for each in self._of_side)):
            for edge, at in ((first, first), (end - 1, self._ends[end - 1])):
                if number:
                    length = min(self._height, 0.5 * self._length(first, end))
                    yield np.stack([self._points[at], self._points[at] + length * self._inward(edge)])

    def numbers(self) -> Iterator[_Number]:
        """Yield the number of each side of each seam, inside the island beside its middle."""
        for number, first, end in zip(self._pattern.seams.tolist(), *(each.tolist() for each in self._of_side)):
            length = self._length(first, end)
            if not (number and length > 0.0):
                continue
            height = min(self._height, length / (_DIGIT_WIDTH * (len(str(number)) + 1)))
            # Across a corner, along the line that cuts it off.
            low, middle, high = (self._at(first, end, 0.5 * length + offset) for offset in (-height, 0.0, height))
            along = high - low if (high != low).any() else np.array([1.0, 0.0])
            along /= np.hypot(*along)
            inward = self._pattern.inward[first] * np.array([-along[1], along[0]])
            center = (low + high + middle) / 3.0 + height * inward
            # Text reads from the left to the right.
            x, y = along if along[0] > 0.0 or (along[0] == 0.0 and along[1] > 0.0) else -along
            yield _Number(str(number), center, float(np.degrees(np.arctan2(y, x))), height)

    def _at(self, first: int, end: int, length: float) -> npt.NDArray[np.float64]:
        """Return the point at this length from the begin of a side."""
        points = np.append(self._points[first:end], self._points[self._ends[end - 1 : end]], axis=0)
        lengths = np.append(0.0, np.cumsum(self._edge_lengths(first, end)))
        return np.array([np.interp(length, lengths, points[:, axis]) for axis in (0, 1)])

    def _edge_lengths(self, first: int, end: int) -> npt.NDArray[np.float64]:
        edges = self._points[self._ends[first:end]] - self._points[first:end]
        return np.hypot(edges[:, 0], edges[:, 1])

    def _length(self, first: int, end: int) -> float:
        return float(self._edge_lengths(first, end).sum())

    def _inward(self, edge: int) -> npt.NDArray[np.float64]:
        """Return the direction into the island from the edge that begins at a point; 0 if it has no length."""
        x, y = self._points[self._ends[edge]] - self._points[edge]
        return np.array([-y, x]) * self._pattern.inward[edge] / (np.hypot(x, y) or 1.0)


def check(suffixes: Iterable[str]) -> None:
    """Raise ValueError if what files with these suffixes need is not installed."""
    if ".dxf" in suffixes and importlib.util.find_spec("ezdxf") is None:
        raise ValueError('DXF needs ezdxf: pip install "spectral_conformal[batch]", or ezdxf.')


def svg(pattern: Pattern, millimeters: float = 1.0) -> str:
    """Return a pattern as SVG 1.1 at 1:1: one unit of its coordinates is a millimeter, on paper, too.

    Outlines are red hairlines to cut; numbers and the ends of seams are black.

    Args:
        pattern: see `pattern`.
        millimeters: per unit of its lengths.
    """
    sheet = _Sheet(pattern, millimeters)
    width, height = sheet.size + 2.0 * _LINE
    root = ElementTree.Element(
        "svg",
        {
            "xmlns": "http://www.w3.org/2000/svg",
            "width": f"{width:.17g}mm",
            "height": f"{height:.17g}mm",
            "viewBox": f"0 0 {width:.17g} {height:.17g}",
        },
    )

    def shown(points: npt.NDArray[np.float64]) -> str:
        """Return points with y downward."""
        return " ".join(f"{x + _LINE:.17g},{height - _LINE - y:.17g}" for x, y in points.tolist())

    thin = {"fill": "none", "stroke-width": str(_LINE)}
    group = ElementTree.SubElement(root, "g", {"id": _OUTLINE, "stroke": "#ff0000", **thin})
    for points in sheet.outlines():
        ElementTree.SubElement(group, "polygon", {"points": shown(points)})
    group = ElementTree.SubElement(root, "g", {"id": _ENDS, "stroke": "#000000", **thin})
    for points in sheet.seam_ends():
        ElementTree.SubElement(group, "polyline", {"points": shown(points)})
    style = {"fill": "#000000", "font-family": "sans-serif", "text-anchor": "middle"}
    group = ElementTree.SubElement(root, "g", {"id": _NUMBERS, **style})
    for number in sheet.numbers():
        x, y = number.center[0] + _LINE, height - _LINE - number.center[1]
        # Digits are about 0.7 of the font's size high; their middle is the center.
        how = {"x": f"{x:.6g}", "y": f"{y + 0.35 * number.height:.6g}", "font-size": f"{number.height:.4g}"}
        turn = f"rotate({-number.angle:.6g} {x:.6g} {y:.6g})"
        ElementTree.SubElement(group, "text", {**how, "transform": turn}).text = number.text
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def dxf(pattern: Pattern, millimeters: float = 1.0) -> str:
    """Return a pattern as DXF R2000 in millimeters, with layers for outlines, the ends of seams and their numbers.

    Args:
        pattern: see `pattern`.
        millimeters: per unit of its lengths.

    Raises:
        ValueError: `ezdxf` is not installed.
    """
    check((".dxf",))
    import ezdxf

    sheet = _Sheet(pattern, millimeters)
    # Otherwise the time and random numbers that name the file change every time.
    before, ezdxf.options.write_fixed_meta_data_for_testing = ezdxf.options.write_fixed_meta_data_for_testing, True
    try:
        document = ezdxf.new("R2000", units=_DXF_MILLIMETERS)
        for name, color in ((_OUTLINE, 1), (_ENDS, 7), (_NUMBERS, 7)):
            document.layers.add(name, color=color)
        space = document.modelspace()
        for points in sheet.outlines():
            space.add_lwpolyline(points.tolist(), close=True, dxfattribs={"layer": _OUTLINE})
        for points in sheet.seam_ends():
            space.add_line(*points.tolist(), dxfattribs={"layer": _ENDS})
        for number in sheet.numbers():
            how = {"height": number.height, "rotation": number.angle, "dxfattribs": {"layer": _NUMBERS}}
            text = space.add_text(number.text, **how)
            text.set_placement(number.center.tolist(), align=ezdxf.enums.TextEntityAlignment.MIDDLE_CENTER)
        stream = io.StringIO()
        document.write(stream)
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before
    return stream.getvalue()


# By the suffixes of their files.
FORMATS = {".svg": svg, ".dxf": dxf}
