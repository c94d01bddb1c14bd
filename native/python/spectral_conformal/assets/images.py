"""Image files: read and write their pixels as they are stored, by OpenImageIO.

Pillow would reduce 16-bit colors to 8 bits.
"""

from __future__ import annotations

import contextlib
import errno
import importlib.util
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from .. import _native
from .mesh import AssetError

# Loses less than textures do by being drawn anew; colors keep their resolution.
_JPEG = {"Compression": "jpeg:95", "jpeg:subsampling": "4:4:4"}
_BEGINNINGS = {
    b"\x89PNG": ".png",
    b"\xff\xd8\xff": ".jpg",
    b"RIFF": ".webp",
    b"II*\0": ".tif",
    b"MM\0*": ".tif",
    b"BM": ".bmp",
    b"v/1\x01": ".exr",
}
_FAILED = "An image cannot be written; is the disk full?"
# Bytes of a file beside its pixels.
_HEAD = 1 << 16
# TGA has no such bytes.
_READABLE = (*_BEGINNINGS.values(), ".tga")
OF_GLTF = (".png", ".jpg", ".webp")
UNKNOWN = "only PNG, JPEG, WebP, TIFF, TGA, BMP and EXR can be read"
MIME_TYPES = {".png": "image/png", ".jpg": "image/jpeg"}
# Of which rebaking reads the numbers as they are; others become floats.
_NUMBERS = ("uint8", "uint16", "half", "float")
_MAX_CHANNELS = 4


class _BrokenError(Exception):
    """What OpenImageIO says, in lines."""


def read(content: bytes, suffix: str = "") -> np.ndarray:
    """Return the pixels of an image file, (height, width, channels), without conversions of color.

    Args:
        content: of the file.
        suffix: of its name, for a kind that its first bytes do not tell.

    Raises:
        AssetError: it is another kind of file, is broken, or OpenImageIO is not installed.
    """
    with _opened(content, suffix) as (source, kind):
        pixels = source.read_image(kind)
        if pixels is None:
            raise _BrokenError(source.geterror())
    return pixels.reshape(*pixels.shape[:2], -1)


def shape_of(content: bytes, suffix: str = "") -> tuple[tuple[int, int, int], np.dtype]:
    """Return the height, width, number of channels and type of the pixels that `read` returns, without reading them.

    The arguments and errors are those of `read`, except for errors in the pixels.
    """
    with _opened(content, suffix) as (source, kind):
        spec = source.spec()
        return (spec.height, spec.width, spec.nchannels), np.dtype({"half": "f2", "float": "f4"}.get(kind, kind))


def wraps_of(content: bytes, suffix: str = "") -> tuple[str, str]:
    """Return how an image file says that it continues along u and v: black, clamp, periodic, mirror; empty if not.

    The arguments and errors are those of `shape_of`.
    """
    with _opened(content, suffix) as (source, _):
        # Of OpenEXR and TIFF; one mode may stand for both.
        modes = source.spec().get_string_attribute("wrapmodes").split(",")
    return modes[0], modes[-1]


@contextlib.contextmanager
def _opened(content: bytes, suffix: str) -> Iterator[tuple[Any, str]]:
    """Open an image file; yield what OpenImageIO reads it by, and the kind of numbers to read.

    Raises:
        AssetError: as `read`, also for the caller's `_BrokenError`.
    """
    suffix = suffix_of(content) or suffix
    if suffix not in _READABLE:
        raise AssetError(UNKNOWN)
    oiio = _library()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"image{suffix}"
        path.write_bytes(content)
        as_stored = oiio.ImageSpec()
        as_stored.attribute("oiio:UnassociatedAlpha", 1)
        source = oiio.ImageInput.open(str(path), as_stored)
        try:
            if source is None:
                raise _BrokenError(oiio.geterror())
            with contextlib.closing(source):
                spec = source.spec()
                _check_size(spec)
                if spec.nchannels > _MAX_CHANNELS:
                    raise AssetError(f"it has {spec.nchannels} channels")
                kind = str(spec.format)
                yield source, kind if kind in _NUMBERS else "float"
        except _BrokenError as error:
            lines = str(error).replace(str(path), "it").strip().splitlines()
            raise AssetError(lines[0] if lines else "it is broken") from error


def _check_size(spec: Any) -> None:  # noqa: ANN401 - OpenImageIO's own type
    """Raise AssetError for an image that is too large to be drawn."""
    if max(spec.width, spec.height) > _native.MAX_IMAGE_SIDE:
        raise AssetError(f"it has {spec.width}x{spec.height} pixels; a side may have {_native.MAX_IMAGE_SIDE}")


def written(pixels: np.ndarray, suffix: str) -> bytes:
    """Return the content of a file with these pixels, (height, width, channels).

    Args:
        pixels: as `read` returns them; those of EXR are halves only if they were.
        suffix: as `written_as` returns it.

    Raises:
        OSError: it cannot be written.
    """
    oiio = _library()
    height, width, n_channels = pixels.shape
    is_half = suffix == ".exr" and pixels.dtype == np.float16
    kind = pixels.dtype.name if pixels.dtype.kind == "u" else "half" if is_half else "float"
    spec = oiio.ImageSpec(width, height, n_channels, kind)
    attributes: dict[str, Any] = {"oiio:UnassociatedAlpha": 1, **(_JPEG if suffix == ".jpg" else {})}
    for name, value in attributes.items():
        spec.attribute(name, value)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"image{suffix}"
        # On a full disk, PNG files end early without an error, and the library of JPEG ends the process.
        if shutil.disk_usage(folder).free < pixels.nbytes + _HEAD:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), tempfile.gettempdir())
        target = oiio.ImageOutput.create(str(path))
        if target is None:
            raise OSError(oiio.geterror())
        is_written = target.open(str(path), spec) and target.write_image(np.ascontiguousarray(pixels))
        if not (target.close() and is_written):
            raise OSError(target.geterror() or _FAILED)
        content = path.read_bytes()
    try:
        read(content, suffix)
    except AssetError as error:
        raise OSError(_FAILED) from error
    return content


def can_write() -> bool:
    """Return whether OpenImageIO is installed."""
    return importlib.util.find_spec("OpenImageIO") is not None


def written_as(suffix: str) -> str:
    """Return the suffix of the file to write for one with this suffix, which keeps its numbers."""
    return {".webp": ".png", ".jpeg": ".jpg", ".tiff": ".tif"}.get(suffix, suffix)


def suffix_of(content: bytes) -> str:
    """Return the suffix for a file by its first bytes; empty for an unknown kind."""
    return next((suffix for beginning, suffix in _BEGINNINGS.items() if content.startswith(beginning)), "")


def _library() -> Any:  # noqa: ANN401 - a module
    try:
        import OpenImageIO
    except ImportError as error:
        raise AssetError('textures need OpenImageIO: pip install "spectral_conformal[batch]"') from error
    return OpenImageIO
