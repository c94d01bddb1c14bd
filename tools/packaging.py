# SPDX-License-Identifier: GPL-3.0-or-later
"""The installable zips: for Blender 3.4 to 4.1 with the native module inside, for 4.2 and later an extension."""

from __future__ import annotations

import os
import platform
import re
import shutil
import zipfile
from pathlib import Path

from tools import steps
from tools.environment import PYTHON, VENV, wheel
from tools.steps import BUILD, ROOT, StepError

ADDON = ROOT / "addon"
PACKAGES = BUILD / "packages"
REPAIRED = BUILD / "wheels-repaired"
NAME = "spectral_unwrap"
MANIFEST = "blender_manifest.toml"
# Blender's names for processors.
ARCHITECTURES = {"x86_64": "x64", "aarch64": "arm64"}
# The earliest time that a zip can hold: equal content gives equal bytes.
ZIP_TIME = (1980, 1, 1, 0, 0, 0)


def run() -> int:
    """Write the zips to build/packages/."""
    module = repair_wheel()
    architecture = ARCHITECTURES.get(platform.machine(), platform.machine())
    python = module.name.split("-")[2]
    target = f"{NAME}-{version()}", f"linux_{architecture}-{python}.zip"
    shutil.rmtree(PACKAGES, ignore_errors=True)
    PACKAGES.mkdir(parents=True)
    extension = PACKAGES / "-".join(target)
    with steps.progress("packing"):
        write_zip(PACKAGES / "-legacy-".join(target), legacy_files(module))
        write_zip(extension, extension_files(module, f"linux-{architecture}"))
    validate(extension)
    for path in sorted(PACKAGES.iterdir()):
        print(f"{path.relative_to(ROOT)}  {path.stat().st_size / 1e6:.1f} MB")
    return 0


def version() -> str:
    """Return the project's version."""
    # tomllib comes with Python 3.11 only.
    found = re.search(r'^version = "(.+)"$', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)
    if not found:
        raise StepError('pyproject.toml has no line: version = "..."')
    return found.group(1)


def repair_wheel() -> Path:
    """Return the wheel of spectral_conformal with the shared libraries that it needs inside."""
    built = wheel()
    state = steps.digest([built])
    if not steps.is_done("repair", state) or not list(REPAIRED.glob("*.whl")):
        shutil.rmtree(REPAIRED, ignore_errors=True)
        steps.run(
            "putting shared libraries into the wheel (auditwheel)",
            [PYTHON, "-m", "auditwheel", "repair", "--wheel-dir", REPAIRED, built],
            log="package", environ={"PATH": f"{PYTHON.parent}:{os.environ['PATH']}"},
        )  # fmt: skip
        steps.mark_done("repair", state)
    return next(REPAIRED.glob("*.whl"))


def addon_files() -> dict[str, bytes]:
    """Return the add-on's source files by path in the package."""
    files = {path.relative_to(ADDON).as_posix(): path.read_bytes() for path in steps.source_files(ADDON)}
    files["LICENSE"] = (ROOT / "LICENSE").read_bytes()
    return files


def legacy_files(module: Path) -> dict[str, bytes]:
    """Return the files of the zip for Blender 3.4 to 4.1: one folder, the unpacked wheel inside."""
    files = addon_files()
    # bl_info is what these versions read.
    files.pop(MANIFEST)
    with zipfile.ZipFile(module) as unpacked:
        # The libraries stay beside the module's folder, where its run path looks for them.
        names = [name for name in unpacked.namelist() if ".dist-info/" not in name and not name.endswith("/")]
        files.update((name, unpacked.read(name)) for name in names)
    return {f"{NAME}/{name}": content for name, content in files.items()}


def extension_files(module: Path, blender_platform: str) -> dict[str, bytes]:
    """Return the files of the extension for Blender 4.2 and later, which installs the wheel itself."""
    files = addon_files()
    # Keys at the top: further down they could land in a table.
    keys = f'platforms = ["{blender_platform}"]\nwheels = ["./wheels/{module.name}"]\n'
    files[MANIFEST] = keys.encode() + files[MANIFEST]
    files[f"wheels/{module.name}"] = module.read_bytes()
    return files


def write_zip(path: Path, files: dict[str, bytes]) -> None:
    """Write a zip whose bytes depend on the files alone."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, ZIP_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, files[name])


def validate(extension: Path) -> None:
    """Let Blender's own tool check the extension, where bpy brings it along."""
    tool = next(VENV.glob("lib/python*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"), None)
    if tool:
        steps.run("validating the extension (blender_ext.py)", [PYTHON, tool, "validate", extension], log="package")
    else:
        print("- the extension was not validated: that needs bpy 4.2 or later")
