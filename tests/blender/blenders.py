# SPDX-License-Identifier: GPL-3.0-or-later
"""The Blenders that the tests run in, and profiles in which the add-on is installed."""

import importlib.util
import os
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from tools import environment  # noqa: E402 - found only now

ADDON = ROOT / "addon"
PYTEST_RUNNER = Path(__file__).with_name("run_pytest.py")


@dataclass(frozen=True)
class Blender:
    """One way to run Blender.

    Attributes:
        name: for the reader of the test report.
        python: the interpreter that imports this Blender as `bpy`; None for a Blender with a program of its own.
        pytest_command: the words before pytest's own arguments.
        bundles_module: whether the add-on carries `spectral_conformal` inside, as the zip for 3.4 to 4.1 does;
            otherwise it stands at top level, as an extension's wheel does.
    """

    name: str
    python: Path | None
    pytest_command: tuple[str, ...]
    bundles_module: bool

    def script_command(self, script: Path) -> list[str]:
        """Return the command that runs a Python script in this Blender, in background mode."""
        if self.python:
            return [str(self.python), str(script)]
        return ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", str(script)]


def system_blender() -> str:
    """Return the path of the system's Blender."""
    path = shutil.which("blender")
    if path is None:
        raise FileNotFoundError(
            "Blender is missing: apt-get install blender python3-numpy (or run build_addon.py test)"
        )
    return path


def all_blenders() -> list[Blender]:
    """Return the system's Blender and, where there is a `bpy` for this Python, all versions of it."""
    packages = str(Path(importlib.util.find_spec("pytest").origin).parents[1])
    run_script = ("--background", "--factory-startup", "--python-exit-code", "1", "--python", str(PYTEST_RUNNER))
    blenders = [Blender("system", None, ("blender", *run_script, "--", packages), bundles_module=True)]
    for version, folder in environment.bpy_environments().items():
        python = folder / "bin" / "python"
        blenders.append(Blender(f"bpy-{version}", python, (str(python), "-m", "pytest"), bundles_module=False))
    return blenders


def make_profile(folder: Path, bundles_module: bool) -> dict[str, str]:
    """Install the add-on, by links, into a Blender profile in `folder`; return the environment to run Blender with."""
    addon = folder / "scripts" / "addons" / "spectral_unwrap"
    addon.mkdir(parents=True)
    for path in ADDON.iterdir():
        (addon / path.name).symlink_to(path)
    if bundles_module:
        module = importlib.util.find_spec("spectral_conformal")
        if module is None:
            raise ModuleNotFoundError("spectral_conformal is not built: run build_addon.py test")
        (addon / "spectral_conformal").symlink_to(Path(module.origin).parent)
    return {
        **os.environ,
        "BLENDER_USER_SCRIPTS": str(folder / "scripts"),
        "BLENDER_USER_CONFIG": str(folder / "config"),
        "BLENDER_USER_DATAFILES": str(folder / "datafiles"),
    }
