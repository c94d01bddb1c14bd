# SPDX-License-Identifier: GPL-3.0-or-later
"""The Blenders that the tests run in, and profiles in which the add-on is installed."""

import functools
import importlib.util
import os
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tools import environment, other_pythons, systems
from tools.steps import ROOT

ADDON = ROOT / "addon"
PYTEST_RUNNER = Path(__file__).with_name("run_pytest.py")
# For Python's path: what it imports when it starts.
STARTUP = Path(__file__).with_name("startup")
# Blenders that are not built for Debian ignore PYTHONPATH unless an option says otherwise.
BACKGROUND = ("--background", "--factory-startup", "--python-use-system-env", "--python-exit-code", "1")


@dataclass(frozen=True)
class Blender:
    """One way to run Blender.

    Attributes:
        name: for the reader of the test report, and for the option --blender.
        python: the interpreter that imports this Blender as `bpy`; None for a Blender with a program of its own.
        system: the other release of Debian that it runs in; None for this machine.
        packages: folders for Python's path.
    """

    name: str
    python: str | None = None
    system: systems.System | None = None
    packages: tuple[Path, ...] = ()

    @property
    def is_further(self) -> bool:
        """Return whether tests in it are left for --all: it is neither the system's nor the bpy of this Python."""
        return bool(self.system) or self.python not in (None, str(environment.PYTHON))

    @property
    def bundles_module(self) -> bool:
        """Return whether the add-on carries `spectral_conformal` inside, as the zip for 3.4 to 4.1 does.

        Otherwise it is at top level, like an extension's wheel.
        """
        return self.python is None

    def command(self, *options: object) -> list[str]:
        """Return the command that runs this Blender, or the Python of this bpy, with options."""
        if self.system:
            return self.system.command([self.python or "blender", *options])
        return [self.python or system_blender(), *map(str, options)]

    def script_command(self, script: Path) -> list[str]:
        """Return the command that runs a Python script in this Blender, in background mode."""
        return self.command(script) if self.python else self.command(*BACKGROUND, "--python", script)

    def pytest_command(self) -> list[str]:
        """Return the words before pytest's own arguments."""
        return self.command("-m", "pytest") if self.python else [*self.script_command(PYTEST_RUNNER), "--"]

    def make_profile(self, folder: Path) -> dict[str, str]:
        """Install the add-on, by links, into a profile in `folder`; return the environment to run this Blender with.

        In it the project's folder is on Python's path, so that scripts can import `tests` and `tools`.
        """
        addon = folder / "scripts" / "addons" / "spectral_unwrap"
        addon.mkdir(parents=True)
        for path in ADDON.iterdir():
            (addon / path.name).symlink_to(path)
        if self.bundles_module:
            for path in self.module():
                (addon / path.name).symlink_to(path)
        return {
            **os.environ,
            "BLENDER_USER_SCRIPTS": str(folder / "scripts"),
            "BLENDER_USER_CONFIG": str(folder / "config"),
            "BLENDER_USER_DATAFILES": str(folder / "datafiles"),
            "PYTHONPATH": os.pathsep.join(
                filter(None, [str(ROOT), str(STARTUP), *map(str, self.packages), os.environ.get("PYTHONPATH")])
            ),
        }

    def module(self) -> Sequence[Path]:
        """Return the folders of the native module, as they stand side by side in the zip for 3.4 to 4.1."""
        if self.system:
            site = other_pythons.site(self.system.python)
            return [site / "spectral_conformal", site / "spectral_conformal.libs"]
        return [package_folder("spectral_conformal")]


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
    """Return the Blenders in which everything is tested without a window.

    The system's, all versions of `bpy` for this Python, and the newest in Debian 13 where there is such a system.
    """
    versions = environment.bpy_environments().items()
    found = [Blender("system"), *(Blender(f"bpy-{name}", str(folder / "bin" / "python")) for name, folder in versions)]
    if systems.TRIXIE.is_made:
        packages = (environment.NEWEST_BPY_FOLDER, other_pythons.site(systems.TRIXIE.python))
        found.append(Blender(f"bpy-{environment.NEWEST_BPY}", "python3", systems.TRIXIE, packages))
    return tuple(found)


@functools.cache
def further_blenders() -> tuple[Blender, ...]:
    """Return the Blenders of other systems, which the tests use only if --blender names them."""
    made = [system for system in systems.wanted() if system.is_made]
    return tuple(Blender(system.suite, system=system) for system in made)


@functools.cache
def blenders_with_window() -> tuple[Blender, ...]:
    """Return the Blenders that this machine has with a window."""
    return (Blender("system"), *further_blenders())


def run(command: list[str], *, environ: dict[str, str], folder: Path, seconds: float) -> tuple[int | None, str]:
    """Run a Blender to its end; return its exit code, None when stopped after `seconds`, and what it printed."""
    try:
        result = subprocess.run(
            command,
            env=environ,
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=seconds,
        )
    except subprocess.TimeoutExpired as error:
        return None, (error.stdout or b"").decode(errors="replace")
    return result.returncode, result.stdout


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
