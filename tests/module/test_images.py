# SPDX-License-Identifier: GPL-3.0-or-later
"""Image files that cannot be read or written whole."""

import shutil
import subprocess
import sys
from collections import namedtuple

import numpy as np
import pytest
from spectral_conformal.assets import AssetError, images

from tests.module.textured_assets import encoded

pytest.importorskip("OpenImageIO")
WRITE = """
import resource
import numpy as np
from spectral_conformal.assets import images
resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))
try:
    images.written(np.random.default_rng(0).integers(0, 255, (256, 256, 3), np.uint8), ".png")
except OSError as error:
    print("refused:", error)
"""


def test_an_image_that_is_too_wide_is_said():
    content = encoded(np.zeros((1, 65_536, 3), np.uint8))
    with pytest.raises(AssetError, match="it has 65536x1 pixels; a side may have 65535"):
        images.read(content)


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of the size of files")
def test_a_file_that_ends_early_is_no_image():
    done = subprocess.run([sys.executable, "-c", WRITE], capture_output=True, text=True, timeout=100)
    assert done.stdout == "refused: An image cannot be written; is the disk full?\n", done.stderr


@pytest.mark.parametrize("suffix", [".png", ".jpg"])
def test_a_full_disk_is_said(suffix, monkeypatch):
    """The library of JPEG would end the process."""
    monkeypatch.setattr(shutil, "disk_usage", lambda path: namedtuple("Usage", "free")(20_000))
    with pytest.raises(OSError, match="No space left on device"):
        images.written(np.zeros((100, 100, 3), np.uint8), suffix)
