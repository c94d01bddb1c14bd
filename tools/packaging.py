# SPDX-License-Identifier: GPL-3.0-or-later
"""The installable zips: an add-on with the native module for Blender 3.4 to 4.1, an extension for 4.2 and later."""

from __future__ import annotations

import json
import os
import platform
import re
import shutil
import tempfile
import zipfile
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from tools import manual, paths, steps, wheels
from tools.environment import PYTHON, bpy_environments, site_packages, system_blender_version, wheel
from tools.steps import BUILD, ROOT, StepError

ADDON = ROOT / "addon"
PACKAGES = BUILD / "packages"
REPAIRED = BUILD / "wheels-repaired"
NAME = "spectral_unwrap"
MANIFEST = "blender_manifest.toml"
NOTES = "NOTES.txt"
# Blender's names for processors and, by the start of a wheel's platform tag, for systems.
ARCHITECTURES = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64", "arm64": "arm64"}
SYSTEMS = {"manylinux": "linux", "linux": "linux", "win": "windows", "macosx": "macos"}
# The Pythons of Blender 3.4 to 4.1, and the oldest one of 4.2 and later.
LEGACY_PYTHONS = ("cp310", "cp311")
OLDEST_EXTENSION_PYTHON = 11
OLDEST_WITH_EXTENSIONS = (4, 2)
LICENSES = re.compile(r"^.+\.dist-info/licenses/(?!LICENSE$)")
# The earliest time that a zip can store, so that equal content gives equal bytes.
ZIP_TIME = (1980, 1, 1, 0, 0, 0)


def is_for_legacy_zips(tag: str) -> bool:
    """Return whether a Blender before 4.2 has the Python of this tag: its own or, from a distribution, the system's."""
    return tag in LEGACY_PYTHONS or (0,) < system_blender_version() < OLDEST_WITH_EXTENSIONS


def run() -> int:
    """Write to build/packages/ the zips that a Blender with this Python can load."""
    module = repair_wheel()
    architecture = ARCHITECTURES.get(platform.machine(), platform.machine())
    tag = python_tag(module)
    target = f"{NAME}-{version()}", f"linux_{architecture}-{tag}.zip"
    extension = PACKAGES / "-".join(target)
    shutil.rmtree(PACKAGES, ignore_errors=True)
    PACKAGES.mkdir(parents=True)
    with steps.progress("packing"):
        if is_for_legacy_zips(tag):
            write_zip(PACKAGES / "-legacy-".join(target), legacy_files(module))
        if for_extensions(module):
            write_zip(extension, extension_files([module], [f"linux-{architecture}"]))
    if for_extensions(module):
        validate(extension)
    if not any(PACKAGES.iterdir()):
        raise StepError(
            f"No Blender from 3.4 on has the Python of this wheel, {tag}: run this with Python 3.10 (Blender 3.4 to "
            "4.0), 3.11 (3.4 of Debian 12, 4.1 to 5.0) or 3.13 (from 5.1)."
        )
    report(PACKAGES)
    return 0


def run_with_wheels(folder: Path, output: Path = PACKAGES, notes: Mapping[str, str] | None = None) -> int:
    """Write the zips of all platforms with wheels in `folder`: one extension each, one legacy zip per Python.

    `notes` has the text of NOTES.txt, by Blender's name of the platform.
    """
    modules = sorted(paths.existing_folder(folder).glob("spectral_conformal-*.whl"))
    for_extension = [module for module in modules if for_extensions(module)]
    if not for_extension:
        raise StepError(
            f"{folder} holds no wheel of spectral_conformal for Python 3.{OLDEST_EXTENSION_PYTHON} or later."
        )
    tools = extension_tools()
    if not tools:
        raise StepError(
            "Blender's own tool packs the extensions: run this with Python 3.11 or 3.13, which have a bpy, or "
            "install Blender 4.2 or later."
        )
    shutil.rmtree(output, ignore_errors=True)
    output.mkdir(parents=True)
    with steps.progress("packing legacy zips"):
        for module in modules:
            if python_tag(module) in LEGACY_PYTHONS:
                platform_name = blender_platform(module)
                target = f"{platform_name.replace('-', '_')}-{python_tag(module)}"
                noted = {f"{NAME}/{name}": content for name, content in note_files(notes, platform_name).items()}
                write_zip(output / f"{NAME}-{version()}-legacy-{target}.zip", {**legacy_files(module), **noted})
    with tempfile.TemporaryDirectory() as source:
        platforms = sorted({blender_platform(module) for module in for_extension})
        for name, content in extension_files(for_extension, platforms).items():
            path = Path(source, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        words = ["--split-platforms", "--source-dir", source, "--output-dir", output]
        newest = list(tools.values())[-1]
        steps.run("packing extensions (Blender's own tool)", [*newest, "build", *words], log="package")
    for name in platforms:
        extension = output / f"{NAME}-{version()}-{name.replace('-', '_')}.zip"
        # The tool gives its files the current time.
        with zipfile.ZipFile(extension) as archive:
            files = {path: archive.read(path) for path in archive.namelist()}
        write_zip(extension, {**files, **note_files(notes, name)})
        validate(extension)
    report(output)
    return 0


def note_files(notes: Mapping[str, str] | None, platform_name: str) -> dict[str, bytes]:
    """Return the file with the notes for one platform, if there are notes."""
    return {NOTES: notes[platform_name].encode()} if notes else {}


def report(folder: Path) -> None:
    """Print the packages and their sizes."""
    for path in sorted(folder.iterdir()):
        print(f"{os.path.relpath(path, ROOT)}  {path.stat().st_size / 1e6:.1f} MB")


def python_tag(module: Path) -> str:
    """Return the Python tag of a wheel, such as cp311."""
    found = re.fullmatch(r"[^-]+-[^-]+(?:-\d[^-]*)?-(cp3\d+)-[^-]+-[^-]+", module.stem)
    if not found:
        raise StepError(f"{module}: the name of a wheel ends with its tags, such as -cp311-cp311-linux_x86_64.whl.")
    return found.group(1)


def for_extensions(module: Path) -> bool:
    """Return whether Blender 4.2 or later uses a wheel's Python."""
    return int(python_tag(module)[3:]) >= OLDEST_EXTENSION_PYTHON


def blender_platform(module: Path) -> str:
    """Return Blender's name of a wheel's platform, such as linux-x64."""
    tag = module.stem.split("-")[-1].split(".")[0]
    system = next((name for start, name in SYSTEMS.items() if tag.startswith(start)), None)
    processor = next((name for end, name in ARCHITECTURES.items() if tag.endswith(f"_{end}")), None)
    if not system or not processor:
        raise StepError(f"Blender runs on no platform with the tag of {module.name}.")
    return f"{system}-{processor}"


def version() -> str:
    """Return the project's version."""
    # tomllib needs Python 3.11.
    found = re.search(r'^version = "(.+)"$', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)
    if not found:
        raise StepError('pyproject.toml has no line: version = "..."')
    return found.group(1)


def repair_wheel() -> Path:
    """Return the wheel of spectral_conformal that contains its shared libraries."""
    built = wheel()
    state = steps.digest([built, Path(wheels.__file__)])
    if not steps.is_done("repair", state) or not list(REPAIRED.glob("*.whl")):
        wheels.repair(built, REPAIRED)
        steps.mark_done("repair", state)
    (repaired,) = REPAIRED.glob("*.whl")
    return repaired


def addon_files() -> dict[str, bytes]:
    """Return the add-on's source files and its manual by path in the package."""
    files = {path.relative_to(ADDON).as_posix(): path.read_bytes() for path in steps.source_files(ADDON)}
    files["LICENSE"] = (ROOT / "LICENSE").read_bytes()
    files.update((f"manual/{name}", content) for name, content in manual.files().items())
    return files


def legacy_files(module: Path) -> dict[str, bytes]:
    """Return the files of the zip for Blender 3.4 to 4.1: one folder, the unpacked wheel inside."""
    files = addon_files()
    # These versions read bl_info.
    files.pop(MANIFEST)
    files["__init__.py"] = with_version(files["__init__.py"])
    try:
        with zipfile.ZipFile(module) as unpacked:
            # The libraries stay beside the module's folder, where its run path looks for them.
            names = [name for name in unpacked.namelist() if ".dist-info/" not in name and not name.endswith("/")]
            files.update((name, unpacked.read(name)) for name in names)
            # Of third-party code, which the wheel keeps beside its own.
            texts = [name for name in unpacked.namelist() if LICENSES.search(name)]
            files.update((LICENSES.sub("licenses/", name), unpacked.read(name)) for name in texts)
    except (zipfile.BadZipFile, zlib.error, EOFError) as error:
        raise StepError(f"{module}: this wheel is incomplete: {error}.") from error
    return {f"{NAME}/{name}": content for name, content in files.items()}


def with_version(source: bytes) -> bytes:
    """Return the add-on's `__init__.py` with the project's version in its `bl_info`."""
    start = b"bl_info = {\n"
    if source.count(start) != 1:
        raise StepError(f"{ADDON / '__init__.py'} has no line: bl_info = {{")
    numbers = ", ".join(version().split("."))
    return source.replace(start, start + f'    "version": ({numbers}),\n'.encode())


def extension_files(modules: Sequence[Path], platforms: Sequence[str]) -> dict[str, bytes]:
    """Return the files of the extension; Blender 4.2 and later choose and install the wheel themselves."""
    files = addon_files()
    listed = [f"./wheels/{module.name}" for module in modules]
    # Keys go to the top: further down they could land in a table. A JSON list of strings is valid TOML.
    keys = f'version = "{version()}"\n'
    keys += f"platforms = {json.dumps(list(platforms))}\nwheels = {json.dumps(listed)}\n"
    files[MANIFEST] = keys.encode() + files[MANIFEST]
    files.update((f"wheels/{module.name}", module.read_bytes()) for module in modules)
    return files


def write_zip(path: Path, files: dict[str, bytes]) -> None:
    """Write a zip whose bytes depend only on the files."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, ZIP_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, files[name])


def validate(extension: Path) -> None:
    """Check the extension with the tool of every available Blender."""
    tools = extension_tools()
    for blender, tool in tools.items():
        steps.run(f"validating {extension.name} ({blender})", [*tool, "validate", extension], log="package")
    if not tools:
        print("- the extension was not validated: that needs bpy, or the system's Blender, 4.2 or later")


def extension_tools() -> dict[str, list[str]]:
    """Return the commands of the available extension tools, by their Blenders, the newest bpy last."""
    tools = {}
    if system_blender_version() >= OLDEST_WITH_EXTENSIONS:
        tools["the system's Blender"] = ["blender", "--factory-startup", "--command", "extension"]
    pattern = "bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"
    for name, folder in bpy_environments().items():
        for path in site_packages(folder).glob(pattern):
            tools[f"bpy {name}"] = [str(PYTHON), str(path)]
    return tools
