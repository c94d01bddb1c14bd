# SPDX-License-Identifier: GPL-3.0-or-later
"""Other Debian releases, for Blenders and Pythons that this one lacks, each in a folder under build/systems/."""

from __future__ import annotations

import functools
import os
import platform
import re
import shutil
import subprocess
import tempfile
from collections.abc import Collection, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from tools import steps
from tools.steps import BUILD, ROOT, StepError

FOLDER = BUILD / "systems"
# Beside the project, if it exists: meshes for some tests.
SHARED = ROOT.parent / "shared"
# A shell whose mounts end with it. In a chroot, the root is no mount and cannot be made private; it usually is already.
OWN_MOUNTS = ("unshare", "--mount", "--propagation", "unchanged", "sh", "-c")
KEEP_PRIVATE = "mount --make-rprivate / 2>/dev/null"


@dataclass(frozen=True)
class System:
    """A release of Debian with a Blender.

    Attributes:
        suite: Debian's name of the release, and the name of its folder.
        packages: the packages to install.
        serves: what the tests run in it, for messages.
    """

    suite: str
    packages: tuple[str, ...]
    serves: str

    @property
    def folder(self) -> Path:
        """Return its root folder."""
        return FOLDER / self.suite

    @property
    def is_made(self) -> bool:
        """Return whether it exists."""
        return steps.is_done(self.folder.name, self.state) and self.folder.is_dir()

    @property
    def state(self) -> str:
        """Return the content of its stamp."""
        return steps.digest([self.suite, *self.packages])

    @property
    def python(self) -> str:
        """Return the version of its Python, such as 3.13."""
        headers = [path.name for path in (self.folder / "usr" / "include").glob("python3.*")]
        if len(headers) != 1:
            raise StepError(f"{self.folder} should have headers of one Python, not {headers}; remove this folder.")
        return headers[0].removeprefix("python")

    def command(self, words: Sequence[object]) -> list[str]:
        """Return the command that runs another one in this system, at the same paths, in the project's folder.

        The project, temporary files and the meshes beside the project are those of this machine. Their mounts exist
        only for the command and end with it.
        """
        shared = [path for path in (ROOT, Path(tempfile.gettempdir()), SHARED) if path.is_dir()]
        mounts = [(path, "--bind") for path in shared] + [(Path(path), "--rbind") for path in ("/proc", "/dev", "/sys")]
        script = f"{KEEP_PRIVATE}; " + "".join(
            f'mkdir -p "$0{path}" && mount {how} "{path}" "$0{path}" && ' for path, how in mounts
        )  # fmt: skip
        script += 'exec chroot "$0" "$@"'
        return [*OWN_MOUNTS, script, str(self.folder), "env", f"--chdir={ROOT}", *map(str, words)]


# Libraries that a bpy wheel links to but does not contain.
FOR_BPY = ("libgl1", "libice6", "libsm6", "libx11-6", "libxfixes3", "libxi6", "libxkbcommon0", "libxrender1")
COMMON = ("blender", "python3-dev", "python3-numpy")
FOR_WINDOW = ("imagemagick", "libgl1", "libgl1-mesa-dri", "mesa-vulkan-drivers", "xdotool")
TRIXIE = System("trixie", (*COMMON, *FOR_BPY, *FOR_WINDOW), "Blender 4.3.2, with a window, and bpy 5.2.3, without")
# Blender's own add-on for extensions needs three of them, but Debian's package does not require them.
FOR_EXTENSIONS = ("python3-cattr", "python3-requests", "python3-zstandard")
SID = System(
    "sid",
    (*COMMON, *FOR_EXTENSIONS, *FOR_WINDOW),
    "Debian unstable's Blender, with a window, also under Vulkan",
)
ALL = (TRIXIE, SID)


def wanted() -> tuple[System, ...]:
    """Return the systems other than this machine's own release."""
    release = re.search(r"^VERSION_CODENAME=(.*)$", release_file(), re.MULTILINE)
    return tuple(system for system in ALL if not release or system.suite != release[1])


def obstacle() -> str | None:
    """Return why no other system can be made here, None if it can."""
    if not re.search(r"^ID=debian$", release_file(), re.MULTILINE):
        return "this is not Debian"
    if platform.machine() != "x86_64":
        return f"the processor is {platform.machine()}, and not x86_64"
    if os.geteuid() != 0:
        return "that needs root"
    if not has_own_mounts():
        return "that needs mounts that this machine does not see, which is not allowed here"
    return None


@functools.cache
def has_own_mounts() -> bool:
    """Return whether a command can have private mounts."""
    # A folder mounted on itself is shared if the mount that contains it is shared.
    script = (
        f'{KEEP_PRIVATE} && exit 0; mount --bind "$0" "$0" || exit 1; '
        'grep -F " $0 " /proc/self/mountinfo | grep -q " shared:"; is_private=$?; umount "$0"; test $is_private -ne 0'
    )
    with tempfile.TemporaryDirectory() as folder:
        return subprocess.run([*OWN_MOUNTS, script, folder], capture_output=True, check=False).returncode == 0


def left_out() -> list[str]:
    """Return one line for every missing system: what is not tested without it, and why it is missing."""
    reason = obstacle()
    return [
        f"not run: {system.serves}: "
        + (f"needs Debian {system.suite} under build/systems, and {reason}" if reason else f"see {log_of(system)}")
        for system in wanted()
        if not system.is_made
    ]


def make_all(suites: Collection[str]) -> None:
    """Make every wanted system of these that is possible; print a line for each that is skipped."""
    if obstacle():
        print("\n".join(f"- {line}" for line in left_out()))
        return
    missing = [system for system in wanted() if not system.is_made and system.suite in suites]
    if not missing:
        return
    names = ", ".join(f"build/systems/{system.suite}" for system in missing)
    with steps.progress(f"making {names}"), ThreadPoolExecutor(len(missing)) as threads:
        attempts = {system: threads.submit(make, system) for system in missing}
    for system, attempt in attempts.items():
        try:
            attempt.result()
        except StepError as error:
            # The other tests continue: unstable cannot always be installed.
            print(f"{error}\n- not run: {system.serves}")


def make(system: System) -> None:
    """Install a system into its folder."""
    shutil.rmtree(system.folder, ignore_errors=True)
    FOLDER.mkdir(parents=True, exist_ok=True)
    # A mirror that lags behind has expired lists, which are good enough for a test.
    options = ['--aptopt=Acquire::Check-Valid-Until "false"', "--variant=apt"]
    steps.run_quietly(
        f"making build/systems/{system.suite}",
        ["mmdebstrap", *options, f"--include={','.join(system.packages)}", system.suite, system.folder, mirror()],
        log=f"system-{system.suite}",
    )
    steps.mark_done(system.folder.name, system.state)


def mirror(apt: Path = Path("/etc/apt")) -> str:
    """Return the address from which this machine installs Debian packages; `apt` is the folder that names it."""
    sources = [apt / "sources.list", *sorted((apt / "sources.list.d").glob("*"))]
    for path in sources:
        if path.suffix in {".list", ".sources"} and path.is_file():
            found = re.search(r"^(?:URIs:|deb\s(?:\[.*?\])?)\s*(\S+/debian/?)(?:\s|$)", path.read_text(), re.MULTILINE)
            if found:
                return found[1]
    raise StepError(f"No file under {apt} names a mirror of Debian, from which another release could be installed.")


def log_of(system: System) -> str:
    """Return the path of a system's installation log, for messages."""
    return f"build/logs/system-{system.suite}.log"


def release_file() -> str:
    """Return the text that describes this machine's system."""
    path = Path("/etc/os-release")
    return path.read_text() if path.is_file() else ""
