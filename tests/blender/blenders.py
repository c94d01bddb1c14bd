# SPDX-License-Identifier: GPL-3.0-or-later
"""The Blenders that the tests run in, and profiles in which the add-on is installed."""

import functools
import importlib.util
import os
import shutil
from dataclasses import dataclass
from pathlib import Path

from tools import environment
from tools.steps import ROOT

ADDON = ROOT / "addon"
PYTEST_RUNNER = Path(__file__).with_name("run_pytest.py")


@dataclass(frozen=True)
class Blender:
    """One way to run Blender.

    Attributes:
        name: for the reader of the test report, and for the option --blender.
        python: the interpreter that imports this Blender as `bpy`; None for a Blender with a program of its own.
        bundles_module: whether the add-on carries `spectral_conformal` inside, as the zip for 3.4 to 4.1 does;
            otherwise it stands at top level, as an extension's wheel does.
    """

    name: str
    python: Path | None
    bundles_module: bool

    def script_command(self, script: Path) -> list[str]:
        """Return the command that runs a Python script in this Blender, in background mode."""
        if self.python:
            return [str(self.python), str(script)]
        # Blenders that are not built for Debian leave PYTHONPATH alone unless they are told.
        options = ["--background", "--factory-startup", "--python-use-system-env", "--python-exit-code", "1"]
        return [system_blender(), *options, "--python", str(script)]

    def pytest_command(self) -> list[str]:
        """Return the words before pytest's own arguments."""
        if self.python:
            return [str(self.python), "-m", "pytest"]
        return [*self.script_command(PYTEST_RUNNER), "--"]


def system_blender() -> str:
    """Return the path of the system's Blender."""
    path = shutil.which("blender")
    if path is None:
        raise FileNotFoundError(
            "Blender is missing: apt-get install blender python3-numpy (or run build_addon.py test)"
        )
    return path


@functools.cache
def all_blenders() -> tuple[Blender, ...]:
    """Return the system's Blender and, where there is a `bpy` for this Python, all versions of it."""
    versions = environment.bpy_environments().items()
    return (
        Blender("system", None, bundles_module=True),
        *(Blender(f"bpy-{name}", folder / "bin" / "python", bundles_module=False) for name, folder in versions),
    )


def make_profile(folder: Path, bundles_module: bool) -> dict[str, str]:
    """Install the add-on, by links, into a Blender profile in `folder`; return the environment to run Blender with.

    In it the project's folder is on Python's path, so that scripts can import `tests` and `tools`.
    """
    addon = folder / "scripts" / "addons" / "spectral_unwrap"
    addon.mkdir(parents=True)
    for path in ADDON.iterdir():
        (addon / path.name).symlink_to(path)
    if bundles_module:
        (addon / "spectral_conformal").symlink_to(package_folder("spectral_conformal"))
    return {
        **os.environ,
        "BLENDER_USER_SCRIPTS": str(folder / "scripts"),
        "BLENDER_USER_CONFIG": str(folder / "config"),
        "BLENDER_USER_DATAFILES": str(folder / "datafiles"),
        "PYTHONPATH": os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")])),
    }


def add_pytest(folder: Path) -> None:
    """Make pytest importable in a profile of a Blender with a program of its own.

    Blender appends `addons/modules` to Python's path, so that its own NumPy and bpy go before those of build/venv.
    """
    (folder / "scripts" / "addons" / "modules").symlink_to(package_folder("pytest").parent)


def package_folder(name: str) -> Path:
    """Return the folder of a package of this environment."""
    found = importlib.util.find_spec(name)
    if found is None:
        raise ModuleNotFoundError(f"{name} is not installed: run build_addon.py test")
    return Path(found.origin).parent
